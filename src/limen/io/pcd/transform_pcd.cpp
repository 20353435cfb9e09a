// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/files/text_numbers.h"
#include "limen/io/pcd/pcd.h"
#include "limen/io/pcd/pcd_header.h"
#include "limen/io/table/moved_columns.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

constexpr std::size_t kPcdRowsAtOnce = 65536;

std::vector<MovedColumns> moved_fields(const PcdHeader& header) {
  return moved_columns([&](std::string_view name, bool direction) -> std::optional<std::size_t> {
    const auto found = std::find_if(header.fields.begin(), header.fields.end(), [&](const PcdField& field) {
      return field.name == name && field.count == 1;
    });
    if (found == header.fields.end() || (direction && found->type != 'F')) return {};
    return static_cast<std::size_t>(found - header.fields.begin());
  });
}

bool becomes_double(const std::vector<MovedColumns>& moved, std::size_t field) {
  return std::any_of(moved.begin(), moved.end(), [&](const MovedColumns& one) {
    return !one.direction && std::find(one.column.begin(), one.column.end(), field) != one.column.end();
  });
}

std::string viewpoint_line(const PcdHeader& header, const Rigid3& motion) {
  const Rigid3 moved = motion * header.viewpoint.value_or(Rigid3{});
  const Eigen::Quaterniond turn(moved.rotation);
  const Vector3d& x = moved.translation;
  return fmt::format("VIEWPOINT {} {} {} {} {} {} {}\n", x.x(), x.y(), x.z(), turn.w(), turn.x(), turn.y(),
                     turn.z());
}

/// SIZE or TYPE with the fields that become double.
std::string per_field_line(const std::vector<std::string_view>& tokens,
                           const std::vector<MovedColumns>& moved) {
  const std::string word(tokens[0]);
  std::string line = word;
  for (std::size_t k = 1; k < tokens.size(); ++k) {
    const bool wide = becomes_double(moved, k - 1);
    line += ' ';
    if (wide) {
      line += word == "SIZE" ? '8' : 'F';
    } else {
      line += tokens[k];
    }
  }
  return line + "\n";
}

std::string header_text(std::string_view bytes, const PcdHeader& header,
                        const std::vector<MovedColumns>& moved, const Rigid3& motion) {
  std::string text;
  for (std::string_view rest = bytes.substr(0, header.body); !rest.empty();) {
    const TextLine line = first_line(rest);
    const auto tokens = split_tokens(line.text);
    const std::string_view word = tokens.empty() ? std::string_view{} : tokens[0];
    if (word == "SIZE" || word == "TYPE") {
      text += per_field_line(tokens, moved);
    } else if (word == "DATA") {
      text += viewpoint_line(header, motion);
      text += header.data == "ascii" ? "DATA ascii\n" : "DATA binary\n";
    } else if (word != "VIEWPOINT") {
      text += std::string(line.text) + "\n";
    }
    rest.remove_prefix(line.bytes);
  }
  return text;
}

/// Where the values of a field lie, and where they go.
struct Column {
  const char* from = nullptr;
  std::size_t stride = 0;
  std::size_t bytes = 0;  ///< of the source
  std::size_t to = 0;     ///< in a record of the output
  Scalar type = Scalar::float32;
};

/// The binary points of a file on their way.
class Records {
 public:
  Records(const PcdHeader& header, const PcdBody& body, std::vector<MovedColumns> moved,
          const std::string& name)
      : moved_(std::move(moved)), points_(header.point_count(name)) {
    const char* at = body.data;
    for (std::size_t k = 0; k < header.fields.size(); ++k) {
      const PcdField& field = header.fields[k];
      const std::size_t bytes = field.size * field.count;
      Column column{at, body.by_field ? bytes : header.record_bytes(), bytes, record_bytes_, Scalar::float32};
      if (field.count == 1 && field.name != "_") column.type = pcd_scalar(field, name);
      at += body.by_field ? bytes * points_ : bytes;
      record_bytes_ += becomes_double(moved_, k) ? sizeof(double) : bytes;
      columns_.push_back(column);
    }
  }

  [[nodiscard]] std::string rows(std::size_t begin, std::size_t end, const Rigid3& motion) const {
    std::string out((end - begin) * record_bytes_, '\0');
    for (std::size_t i = begin; i < end; ++i) {
      char* const record = out.data() + (i - begin) * record_bytes_;
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        const Column& column = columns_[k];
        if (!becomes_double(moved_, k))
          std::memcpy(record + column.to, column.from + i * column.stride, column.bytes);
      }
      for (const MovedColumns& moved : moved_) put_moved(record, i, moved, motion);
    }
    return out;
  }
  [[nodiscard]] std::size_t size() const { return points_; }

 private:
  void put_moved(char* record, std::size_t row, const MovedColumns& moved, const Rigid3& motion) const {
    Vector3d x;
    for (std::size_t k = 0; k < 3; ++k) {
      const Column& column = columns_[moved.column[k]];
      x[static_cast<int>(k)] = load_number(column.from + row * column.stride, column.type, false);
    }
    x = moved.moved(motion, x);
    for (std::size_t k = 0; k < 3; ++k) {
      const Column& column = columns_[moved.column[k]];
      const double value = x[static_cast<int>(k)];
      if (moved.direction && column.type == Scalar::float32) {
        const auto narrow = static_cast<float>(value);
        std::memcpy(record + column.to, &narrow, sizeof narrow);
      } else {
        std::memcpy(record + column.to, &value, sizeof value);
      }
    }
  }

  std::vector<MovedColumns> moved_;
  std::size_t points_;
  std::size_t record_bytes_ = 0;
  std::vector<Column> columns_;
};

std::vector<std::string> column_names(const PcdHeader& header) {
  std::vector<std::string> names;
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count; ++k) names.push_back(field.count == 1 ? field.name : "_");
  }
  return names;
}

}  // namespace

TransformedCloud transform_pcd(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output) {
  const PcdHeader header = parse_pcd_header(input.bytes, input.name);
  const std::vector<MovedColumns> moved = moved_fields(header);
  if (moved.empty() || moved.front().direction)
    throw Error("the points have no x, y and z", input.name, "export the points with them");
  TransformedCloud result{header.point_count(input.name), "PCD, " + header.data, {}};
  if (header.data == "binary_compressed")
    result.notes.emplace_back("the points were compressed; they are written as plain binary numbers");
  const bool text = header.data == "ascii";
  if (text) {
    // Reading all rows proves the file before anything is written.
    const auto stream = open_pcd(input.bytes, input.name)->read(0);
    while (stream->next(kPcdRowsAtOnce)) {
    }
  }
  const PcdBody body = text ? PcdBody{} : open_pcd_body(input.bytes, header, input.name);
  AtomicFile file(output);
  file.write(header_text(input.bytes, header, moved, target_from_source));
  if (text) {
    const LineMover mover(column_names(header), target_from_source);
    file.write(mover.moved(input.bytes.substr(header.body), false, input.name));
  } else {
    const Records records(header, body, moved, input.name);
    for (std::size_t begin = 0; begin < records.size(); begin += kPcdRowsAtOnce)
      file.write(records.rows(begin, std::min(records.size(), begin + kPcdRowsAtOnce), target_from_source));
  }
  file.commit();
  return result;
}

}  // namespace limen
