// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/copc_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/geometry/morton_curve.h"
#include "limen/io/las/laz/laz_pack.h"

// Source: COPC specification 1.0 (https://copc.io): the info record, the hierarchy, the keys of nodes.

namespace limen {

/// A node of the octree and the points that it keeps, in the list of all.
struct CopcNode {
  int level = 0;
  CellIndex at;
  std::size_t begin = 0;
  std::size_t end = 0;
  std::uint64_t place = 0;  ///< of its chunk in the file
  std::uint32_t bytes = 0;
};

struct CopcTree {
  std::vector<CopcNode> nodes;       ///< by level, then along the curve
  std::vector<std::uint32_t> order;  ///< the points of the nodes
};

/// The cube of the root, metres in the file's frame, and the times of the points.
struct CopcExtent {
  Vector3d low = Vector3d::Zero();
  double side = 1.0;
  double earliest = 0.0;
  double latest = 0.0;
};

namespace {

constexpr std::size_t kHeaderBytes = 375;
constexpr std::size_t kInfoAt = kHeaderBytes + kLasRecordHead;  ///< the specification: byte 429
constexpr std::size_t kInfoBytes = 160;
constexpr std::size_t kEntryBytes = 32;
constexpr std::size_t kExtendedHead = 60;
constexpr std::size_t kTimeAt = 22;  ///< of GPS time in records of formats 6 to 8
constexpr std::size_t kBlockRecords = std::size_t{1} << 16U;
constexpr std::size_t kNodesAtOnce = 64;
constexpr std::size_t kFewInNode = 20000;  ///< a node of no more has no children
constexpr int kBits = 21;                  ///< of a cell coordinate along one axis
constexpr int kCellBits = 7;               ///< 128 cells along the edge of a node
constexpr int kDeepest = kBits - kCellBits;

/// Calls use(begin, end) for each run of places that lie in one cube, of the edge of the root over 2^level.
template <typename Use>
void for_each_cube(const CurvePlaces& places, std::size_t begin, std::size_t end, int level, const Use& use) {
  const auto shift = static_cast<unsigned>(3 * (kBits - level));
  while (begin < end) {
    std::size_t stop = begin + 1;
    while (stop < end && (places[stop].code >> shift) == (places[begin].code >> shift)) ++stop;
    use(begin, stop);
    begin = stop;
  }
}

CopcTree octree_of(CurvePlaces left) {
  CopcTree tree;
  tree.order.reserve(left.size());
  CurvePlaces deeper;
  for (int level = 0; !left.empty(); ++level) {
    deeper.clear();
    for_each_cube(left, 0, left.size(), level, [&](std::size_t begin, std::size_t end) {
      const auto shift = static_cast<unsigned>(3 * (kBits - level));
      CopcNode node{level, morton_decode(left[begin].code >> shift), tree.order.size(), 0};
      if (end - begin <= kFewInNode || level == kDeepest) {
        for (std::size_t k = begin; k < end; ++k) tree.order.push_back(left[k].index);
      } else {
        for_each_cube(left, begin, end, level + kCellBits, [&](std::size_t from, std::size_t to) {
          const std::size_t kept = from + (to - from) / 2;
          tree.order.push_back(left[kept].index);
          for (std::size_t k = from; k < to; ++k)
            if (k != kept) deeper.push_back(left[k]);
        });
      }
      node.end = tree.order.size();
      // As they came: neighbours in the file pack best.
      std::sort(tree.order.begin() + static_cast<std::ptrdiff_t>(node.begin), tree.order.end());
      tree.nodes.push_back(node);
    });
    left.swap(deeper);
  }
  return tree;
}

std::string hierarchy_of(const std::vector<CopcNode>& nodes) {
  std::string page(kEntryBytes * nodes.size(), '\0');
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const CopcNode& node = nodes[k];
    const std::size_t at = kEntryBytes * k;
    put_las_number(page, at, std::int32_t{node.level});
    put_las_number(page, at + 4, node.at.x);
    put_las_number(page, at + 8, node.at.y);
    put_las_number(page, at + 12, node.at.z);
    put_las_number(page, at + 16, node.place);
    put_las_number(page, at + 24, node.bytes);
    put_las_number(page, at + 28, static_cast<std::uint32_t>(node.end - node.begin));
  }
  return page;
}

}  // namespace

bool is_copc_ending(const std::filesystem::path& path) {
  return is_laz_ending(path) && lower_case(path.stem().extension().string()) == ".copc";
}

std::string copc_info_record() {
  return las_record("copc", 1, std::string(kInfoBytes, '\0'));
}

CopcWriter::CopcWriter(AtomicFile& file, std::uint64_t points_begin, std::vector<laz::ItemPlan> items,
                       const LasGrid& grid)
    : file_(file), begin_(points_begin), items_(std::move(items)), grid_(grid), point_bytes_(0) {
  for (const laz::ItemPlan& item : items_) point_bytes_ += item.bytes;
}

const char* CopcWriter::record(std::uint32_t index) const {
  return &blocks_[index / kBlockRecords][index % kBlockRecords * point_bytes_];
}

void CopcWriter::write(std::string_view records) {
  const std::size_t full = kBlockRecords * point_bytes_;
  while (!records.empty()) {
    if (blocks_.empty() || blocks_.back().size() == full) {
      blocks_.emplace_back().reserve(full);
      if (blocks_.size() * kBlockRecords > std::numeric_limits<std::uint32_t>::max())
        throw Error("4 thousand million points are too many for one COPC", "the output",
                    "thin the cloud, or write LAZ");
    }
    const std::size_t count = std::min(records.size(), full - blocks_.back().size());
    blocks_.back() += records.substr(0, count);
    records.remove_prefix(count);
  }
}

std::size_t CopcWriter::count() const {
  return blocks_.empty() ? 0 : (blocks_.size() - 1) * kBlockRecords + blocks_.back().size() / point_bytes_;
}

Vector3d CopcWriter::point(std::size_t index) const {
  std::array<std::int32_t, 3> steps{};
  std::memcpy(steps.data(), record(static_cast<std::uint32_t>(index)), sizeof steps);
  return grid_.offset + grid_.scale.cwiseProduct(Vector3d(steps[0], steps[1], steps[2]));
}

CopcExtent CopcWriter::extent() const {
  CopcExtent extent;
  if (count() == 0) return extent;
  const auto time = [&](std::size_t i) {
    return las_number<double>({record(static_cast<std::uint32_t>(i)), point_bytes_}, kTimeAt);
  };
  Vector3d high = point(0);
  extent = {high, 0.0, time(0), time(0)};
  for (std::size_t i = 1; i < count(); ++i) {
    const Vector3d x = point(i);
    extent.low = extent.low.cwiseMin(x);
    high = high.cwiseMax(x);
    extent.earliest = std::min(extent.earliest, time(i));
    extent.latest = std::max(extent.latest, time(i));
  }
  // A little larger, so that the highest point lies within in other programs' arithmetic too.
  extent.side = 1.000001 * std::max((high - extent.low).maxCoeff(), 0.001);
  return extent;
}

CopcTree CopcWriter::tree_in(const CopcExtent& extent) const {
  CurvePlaces places(count());
  parallel_for(count(), kBlockRecords, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3d cell = (point(i) - extent.low) * (std::ldexp(1.0, kBits) / extent.side);
      places[i] = {morton_encode(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                                 static_cast<std::uint32_t>(cell.z())),
                   static_cast<std::uint32_t>(i)};
    }
  });
  sort_along_curve(places);
  return octree_of(std::move(places));
}

std::uint64_t CopcWriter::write_nodes(CopcTree& tree) {
  file_.write(std::string(8, '\0'));  // where the table will be
  std::uint64_t end = begin_ + 8;
  std::vector<laz::ChunkSize> sizes;
  for (std::size_t first = 0; first < tree.nodes.size(); first += kNodesAtOnce) {
    std::vector<std::string> packed(std::min(kNodesAtOnce, tree.nodes.size() - first));
    parallel_for(packed.size(), 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) {
        std::string records;
        for (std::size_t i = tree.nodes[first + k].begin; i < tree.nodes[first + k].end; ++i)
          records.append(record(tree.order[i]), point_bytes_);
        packed[k] = laz::pack_chunk(items_, records);
      }
    });
    for (std::size_t k = 0; k < packed.size(); ++k) {
      CopcNode& node = tree.nodes[first + k];
      node.place = end;
      node.bytes = static_cast<std::uint32_t>(packed[k].size());
      sizes.push_back({static_cast<std::uint32_t>(node.end - node.begin), node.bytes});
      file_.write(packed[k]);
      end += packed[k].size();
    }
  }
  overwrite_las_number(file_, begin_, end);
  const std::string table = laz::pack_table(sizes, true);
  file_.write(table);
  return end + table.size();
}

std::uint64_t CopcWriter::write_hierarchy(const std::vector<CopcNode>& nodes, const CopcExtent& extent,
                                          std::uint64_t at) {
  const std::string page = hierarchy_of(nodes);
  std::string head(kExtendedHead, '\0');
  head.replace(2, 4, "copc");
  put_las_number(head, 18, std::uint16_t{1000});
  put_las_number(head, 20, std::uint64_t{page.size()});
  file_.write(head + page);
  overwrite_las_number(file_, las_at::kLongRecords, at);
  overwrite_las_number(file_, las_at::kLongRecordCount, std::uint32_t{1});

  std::string info(kInfoBytes, '\0');
  const double half = 0.5 * extent.side;
  put_las_vector(info, 0, extent.low + Vector3d::Constant(half));
  put_las_number(info, 24, half);
  put_las_number(info, 32, std::ldexp(extent.side, -kCellBits));
  put_las_number(info, 40, at + kExtendedHead);
  put_las_number(info, 48, std::uint64_t{page.size()});
  put_las_number(info, 56, extent.earliest);
  put_las_number(info, 64, extent.latest);
  file_.overwrite(kInfoAt, info);
  return at + kExtendedHead + page.size();
}

std::uint64_t CopcWriter::finish() {
  const CopcExtent extent = this->extent();
  CopcTree tree = tree_in(extent);
  const std::uint64_t end = write_nodes(tree);
  if (tree.nodes.empty()) tree.nodes.emplace_back();
  return write_hierarchy(tree.nodes, extent, end);
}

}  // namespace limen
