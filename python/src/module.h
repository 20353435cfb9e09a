// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace limen::python {

// The parts of the module limen._limen. The order counts: a type is bound before it is used.
void bind_errors(pybind11::module_& module);
void bind_options(pybind11::module_& module);
void bind_scans(pybind11::module_& module);
void bind_features(pybind11::module_& module);
void bind_registration(pybind11::module_& module);
void bind_deviation(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);

}  // namespace limen::python
