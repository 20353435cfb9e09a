// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_writer.h"

#include <algorithm>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/io/las/las_header.h"

namespace limen {
namespace {

/// So many chunks are collected before all threads pack them; fewer where points are very long.
constexpr std::size_t kChunksAtOnce = 16;
constexpr std::size_t kMostPending = std::size_t{64} << 20U;

}  // namespace

bool is_laz_ending(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".laz";
}

LazWriter::LazWriter(AtomicFile& file, std::uint64_t points_begin, std::vector<laz::ItemPlan> items)
    : file_(file), begin_(points_begin), end_(points_begin), items_(std::move(items)) {
  for (const laz::ItemPlan& item : items_) chunk_bytes_ += item.bytes * kLazChunkPoints;
  file_.write(std::string(8, '\0'));  // the place of the table, known in the end
  end_ += 8;
}

void LazWriter::write(std::string_view records) {
  pending_ += records;
  const std::size_t enough = std::max(chunk_bytes_, std::min(kChunksAtOnce * chunk_bytes_, kMostPending));
  if (pending_.size() >= enough) pack_pending(pending_.size() / chunk_bytes_);
}

void LazWriter::pack_pending(std::size_t chunks) {
  std::vector<std::string> packed(chunks);
  const std::string_view records = pending_;
  parallel_for(chunks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      packed[k] = laz::pack_chunk(items_, records.substr(k * chunk_bytes_, chunk_bytes_));
  });
  for (const std::string& chunk : packed) {
    file_.write(chunk);
    end_ += chunk.size();
    sizes_.push_back({kLazChunkPoints, static_cast<std::uint32_t>(chunk.size())});
  }
  pending_.erase(0, chunks * chunk_bytes_);
}

std::uint64_t LazWriter::finish() {
  pack_pending((pending_.size() + chunk_bytes_ - 1) / chunk_bytes_);
  overwrite_las_number(file_, begin_, end_);
  const std::string table = laz::pack_table(sizes_, false);
  file_.write(table);
  return end_ + table.size();
}

}  // namespace limen
