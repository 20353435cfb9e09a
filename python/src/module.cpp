// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "module.h"

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/version.h"

namespace py = pybind11;

namespace limen::python {
namespace {

/// limen.Error; lives as long as the process.
PyObject* error_type = nullptr;

const char* to_string(Fault fault) {
  if (fault == Fault::input) return "input";
  return fault == Fault::internal ? "internal" : "cancelled";
}

void translate(std::exception_ptr caught) {
  try {
    if (caught) std::rethrow_exception(caught);
  } catch (const Error& error) {
    const py::object value = py::reinterpret_borrow<py::object>(error_type)(error.what());
    value.attr("what") = error.problem();
    value.attr("where") = error.where();
    value.attr("remedy") = error.remedy();
    value.attr("fault") = to_string(error.fault());
    PyErr_SetObject(error_type, value.ptr());
  }
}

}  // namespace

void bind_errors(py::module_& module) {
  error_type = PyErr_NewExceptionWithDoc(
      "limen.Error",
      "What is wrong (`what`), where (`where`: file, line, option), and what to do about it (`remedy`).\n"
      "`fault` tells who has to act: 'input', 'internal' (please report it) or 'cancelled'.",
      PyExc_ValueError, nullptr);
  if (error_type == nullptr) throw py::error_already_set();
  // An error that Python code raises has them too.
  for (const char* part : {"what", "where", "remedy"}) py::handle(error_type).attr(part) = "";
  py::handle(error_type).attr("fault") = "input";
  module.add_object("Error", error_type);
  py::register_exception_translator(&translate);
  module.def(
      "set_threads",
      [](int count) {
        if (count < 0) throw Error(fmt::format("{} is no number of threads", count), "count", "give 0 for all");
        set_thread_count(count);
      },
      py::arg("count"));
  module.def("threads", &thread_count);
  module.attr("__version__") = kVersion;
}

}  // namespace limen::python

PYBIND11_MODULE(_limen, module) {
  using namespace limen::python;
  module.doc() = "The compiled part of limen; use the package limen.";
  bind_errors(module);
  bind_options(module);
  bind_scans(module);
  bind_features(module);
  bind_registration(module);
  bind_deviation(module);
#ifdef LIMEN_WITH_SIMULATOR
  bind_simulation(module);
#endif
}
