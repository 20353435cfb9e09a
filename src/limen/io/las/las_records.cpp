// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/las_records.h"

#include <algorithm>

#include "limen/io/las/laz/laz_records.h"

namespace limen {
namespace {

class PlainRecords : public LasRecords {
 public:
  PlainRecords(const char* data, std::uint64_t count, std::size_t stride)
      : data_(data), left_(count), stride_(stride) {}

  LasPiece next(std::size_t most_rows) override {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, most_rows));
    const LasPiece piece{data_, count};
    data_ += count * stride_;
    left_ -= count;
    return piece;
  }

 private:
  const char* data_;
  std::uint64_t left_;
  std::size_t stride_;
};

}  // namespace

std::unique_ptr<LasRecords> open_las_records(std::string_view bytes, const std::string& name,
                                             const LasHeader& header) {
  if (header.compressed) return open_laz_records(bytes, name, header);
  return std::make_unique<PlainRecords>(bytes.data() + header.points_begin, header.points,
                                        header.point_bytes);
}

}  // namespace limen
