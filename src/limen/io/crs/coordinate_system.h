// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limen {

/// A coordinate system, as far as it is known. Where PROJ is there when the program runs, everything is known
/// of every system; without it what the text itself says.
struct CoordinateSystem {
  std::string stated;  ///< as it was given: "EPSG:2154", WKT or PROJJSON
  std::string name;    ///< "RGF93 v1 / Lambert-93"; empty: not known
  std::string code;    ///< "EPSG:2154"; empty: not known
  std::string wkt;  ///< well-known text, version 1 where the system can be expressed in it; empty: not known

  [[nodiscard]] bool known() const { return !stated.empty(); }
};

/// Understands EPSG:NUMBER, well-known text of either version, and PROJJSON. `where` is in messages.
/// Throws Error for what is none, for systems whose axes are no metres on a plane, and for those that only
/// PROJ knows where that is missing.
CoordinateSystem coordinate_system(const std::string& text, const std::string& where);

/// The same of a text that a file carries: what cannot be understood is kept as it was stated, never an
/// Error.
CoordinateSystem stated_system(const std::string& text);

/// Whether both are the same on the ground; heights are not compared. What is not known of either is no
/// difference.
bool same_system(const CoordinateSystem& a, const CoordinateSystem& b);

/// "RGF93 v1 / Lambert-93 (EPSG:2154)", or the first words of what was stated.
std::string words_of(const CoordinateSystem& system);

}  // namespace limen
