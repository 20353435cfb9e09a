// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "limen/base/error.h"
#include "limen/geometry/rigid.h"

namespace limen::python {

namespace py = pybind11;

using DoubleArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A read-only array that shows the values where they are and keeps `owner` alive.
template <typename Value>
py::array view(const std::vector<Value>& values, std::vector<py::ssize_t> shape, py::handle owner) {
  py::array_t<Value> array(std::move(shape), values.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// The same of points: (n, 3) float64.
inline py::array view(const std::vector<Vector3d>& points, py::handle owner) {
  static_assert(sizeof(Vector3d) == 3 * sizeof(double), "points lie without gaps");
  const double* first = points.empty() ? nullptr : points.front().data();
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}}, first, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// A new array of points, each with `shift` added: (n, 3) float64.
inline py::array points_array(const std::vector<Vector3d>& points, const Vector3d& shift = Vector3d::Zero()) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  auto out = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < out.shape(0); ++i) {
    for (py::ssize_t k = 0; k < 3; ++k) out(i, k) = points[static_cast<std::size_t>(i)][k] + shift[k];
  }
  return array;
}

/// (n, 3), less `origin`. Throws Error where the shape is another or a value is not finite.
std::vector<Vector3d> points_from(const DoubleArray& array, const Vector3d& origin, const char* name);

/// Numbers as NumPy has them, float64. Throws Error where they are none.
DoubleArray doubles_from(const py::object& given, const char* name);

/// One value per point, or one row of `columns`. Throws Error where the shape is another, or integers are asked
/// for and a value is none that the type can hold.
template <typename Value>
std::vector<Value> values_from(const py::object& given, std::size_t count, const char* name,
                               py::ssize_t columns = 1) {
  if (given.is_none()) return {};
  const DoubleArray array = doubles_from(given, name);
  const auto rows = static_cast<py::ssize_t>(count);
  const bool fits = columns == 1 ? array.ndim() == 1 && array.shape(0) == rows
                                 : array.ndim() == 2 && array.shape(0) == rows && array.shape(1) == columns;
  if (!fits)
    throw Error(fmt::format("{} is not of shape ({}{})", name, count,
                            columns == 1 ? "," : fmt::format(", {}", columns)),
                "", "give as many as there are points");
  std::vector<Value> values(static_cast<std::size_t>(array.size()));
  const double* from = array.data();
  for (Value& value : values) {
    const double number = *from++;
    if constexpr (std::is_integral_v<Value>) {
      using Limits = std::numeric_limits<Value>;
      if (!(number >= Limits::min() && number <= Limits::max()) || number != std::floor(number))
        throw Error(fmt::format("{} has the value {}", name, number), "",
                    fmt::format("give whole numbers from {} to {}{}", Limits::min(), Limits::max(),
                                sizeof(Value) == 1 ? ", such as numpy.uint8(255 * x) of x up to 1" : ""));
    }
    value = static_cast<Value>(number);
  }
  return values;
}

}  // namespace limen::python
