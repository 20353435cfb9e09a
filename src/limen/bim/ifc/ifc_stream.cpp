// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_stream.h"

#include <cstring>

#include "limen/bim/ifc/ifc_stream_format.h"

namespace limen {
namespace {

/// What is thrown where a payload does not hold what it should; never leaves this file.
struct Unsound {};

/// Takes numbers off the front of a payload.
class Payload {
 public:
  explicit Payload(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t take_byte() { return static_cast<std::uint8_t>(take_little(1)); }
  std::uint32_t take_count() { return static_cast<std::uint32_t>(take_little(4)); }
  std::int64_t take_entity() { return static_cast<std::int64_t>(take_little(8)); }
  double take_number() {
    const std::uint64_t bits = take_little(8);
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::string take_text() { return std::string(take(take_count())); }
  /// A count of things of at least `bytes_each`: there must be room for them.
  std::uint32_t take_count_of(std::size_t bytes_each) {
    const std::uint32_t count = take_count();
    if (count > bytes_.size() / bytes_each) throw Unsound{};
    return count;
  }
  void expect_end() const {
    if (!bytes_.empty()) throw Unsound{};
  }

 private:
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) throw Unsound{};
    const std::string_view front = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return front;
  }
  std::uint64_t take_little(std::size_t size) {
    const std::string_view front = take(size);
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < size; ++k)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(front[k])) << (8 * k);
    return value;
  }

  std::string_view bytes_;
};

PolygonMesh take_mesh(Payload& payload) {
  PolygonMesh mesh;
  const std::uint32_t points = payload.take_count_of(24);
  mesh.points.reserve(points);
  for (std::uint32_t i = 0; i < points; ++i) {
    const double x = payload.take_number();
    const double y = payload.take_number();
    mesh.points.emplace_back(x, y, payload.take_number());
  }
  const std::uint32_t polygons = payload.take_count_of(4);
  std::vector<std::uint32_t> ring;
  for (std::uint32_t i = 0; i < polygons; ++i) {
    ring.resize(payload.take_count_of(4));
    for (std::uint32_t& corner : ring) {
      corner = payload.take_count();
      if (corner >= points) throw Unsound{};
    }
    if (ring.size() >= 3) mesh.add(ring);
  }
  return mesh;
}

Solid take_solid(Payload& payload, int depth) {
  if (depth > kDeepestIfcNode) throw Unsound{};
  Solid solid;
  switch (static_cast<IfcNode>(payload.take_byte())) {
    case IfcNode::mesh:
      solid.mesh = take_mesh(payload);
      return solid;
    case IfcNode::unite:
      solid.operation = SolidOperation::unite;
      break;
    case IfcNode::intersect:
      solid.operation = SolidOperation::intersect;
      break;
    case IfcNode::subtract:
      solid.operation = SolidOperation::subtract;
      break;
    default:
      throw Unsound{};
  }
  const std::uint32_t children = payload.take_count_of(5);
  for (std::uint32_t i = 0; i < children; ++i) solid.children.push_back(take_solid(payload, depth + 1));
  return solid;
}

IfcProductShapes take_product(Payload& payload) {
  IfcProductShapes product;
  product.id = payload.take_entity();
  product.type = payload.take_text();
  const std::uint32_t shapes = payload.take_count_of(5);
  for (std::uint32_t i = 0; i < shapes; ++i) product.shapes.push_back(take_solid(payload, 0));
  return product;
}

void take_record(IfcRecord record, Payload payload, IfcShapes& shapes) {
  switch (record) {
    case IfcRecord::loaded:
      shapes.metres_per_unit = payload.take_number();
      shapes.loaded = shapes.metres_per_unit > 0.0 && shapes.metres_per_unit < 1e6;
      if (!shapes.loaded) throw Unsound{};
      break;
    case IfcRecord::begin:
      shapes.begun = payload.take_entity();
      break;
    case IfcRecord::product:
      shapes.products.push_back(take_product(payload));
      shapes.begun = 0;
      return payload.expect_end();
    case IfcRecord::message: {
      const std::int64_t id = payload.take_entity();
      shapes.messages.emplace_back(id, payload.take_text());
      break;
    }
    case IfcRecord::refused:
      shapes.refused = payload.take_text();
      break;
    case IfcRecord::end:
      shapes.complete = payload.take_count() == shapes.products.size();
      shapes.begun = 0;
      break;
    default:
      throw Unsound{};
  }
  payload.expect_end();
}

}  // namespace

IfcShapes parse_ifc_stream(std::string_view bytes) {
  IfcShapes shapes;
  if (bytes.substr(0, kIfcStreamMagic.size()) != kIfcStreamMagic) {
    shapes.broken = !bytes.empty();
    return shapes;
  }
  bytes.remove_prefix(kIfcStreamMagic.size());
  try {
    constexpr std::size_t kHead = 5;
    while (bytes.size() >= kHead && !shapes.complete) {
      Payload head(bytes.substr(0, kHead));
      const auto record = static_cast<IfcRecord>(head.take_byte());
      const std::size_t size = head.take_count();
      if (size > bytes.size() - kHead) break;  // cut off: the writer died
      take_record(record, Payload(bytes.substr(kHead, size)), shapes);
      bytes.remove_prefix(kHead + size);
    }
  } catch (const Unsound&) {
    shapes.broken = true;
    shapes.complete = false;
  }
  return shapes;
}

}  // namespace limen
