// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

/// What the program limen_ifc writes and limen reads.
///
/// The stream begins with kIfcStreamMagic. Then come records: a tag (one byte), the length of the payload
/// (uint32) and the payload. Numbers are little-endian: int64, uint32, uint8, float64; a text is its length
/// (uint32) and its bytes. Entities are named by their number in the file (#123).
///   loaded    float64 metres per unit
///   begin     int64 entity: its shape is being made; where the program dies next, this entity killed it
///   product   int64 entity, text class name ("IfcWall"), uint32 count of shapes, the shapes
///   message   int64 entity (0: none), text
///   refused   text: why the file cannot be read at all; nothing follows
///   end       uint32 number of product records before it
/// A shape is a node: uint8 kind, then
///   mesh          uint32 points, three float64 each (metres, world), uint32 polygons; of each uint32 corners
///                 and their uint32 indices
///   unite, intersect, subtract   uint32 children (subtract: all others from the first), the children
namespace limen {

inline constexpr std::string_view kIfcStreamMagic = "LIMENIFC1\n";

enum class IfcRecord : std::uint8_t {
  loaded = 'L',
  begin = 'B',
  product = 'P',
  message = 'M',
  refused = 'R',
  end = 'Z'
};

enum class IfcNode : std::uint8_t { mesh = 0, unite = 1, intersect = 2, subtract = 3 };

/// Nodes are not nested deeper than this.
inline constexpr int kDeepestIfcNode = 60;

}  // namespace limen
