// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/info_table.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "limen/project/state/scan_names.h"

namespace limen {
namespace {

constexpr std::size_t kInfoColumns = 6;
using InfoRow = std::array<std::string, kInfoColumns>;

std::string size_of_box(const Json& box) {
  const auto side = [&](std::size_t k) { return box["high"][k].get<double>() - box["low"][k].get<double>(); };
  return fmt::format("{:.2f} x {:.2f} x {:.2f}", side(0), side(1), side(2));
}

std::string place_words(const Json& scan) {
  const Json& centre = scan["optical_centre"];
  if (!centre.is_array()) return centre.get<std::string>();
  const auto at = [&](std::size_t k) { return centre[k].get<double>() + 0.0; };
  return fmt::format("{:.2f} {:.2f} {:.2f} ({})", at(0), at(1), at(2),
                     scan["scanner"]["source"].get<std::string>());
}

std::string joined_notes(const Json& notes) {
  std::string text;
  for (const Json& note : notes) text += (text.empty() ? "" : "; ") + note.get<std::string>();
  return text;
}

/// "PLY" of "PLY, binary, little-endian".
std::string first_words(const std::string& format) {
  return format.substr(0, format.find(','));
}

/// Places that a text of UTF-8 takes, wide signs counted as one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::vector<InfoRow> rows_of(const Json& file) {
  const std::string name = file["file"];
  if (file.contains("error")) return {{name, "", "", "", "", "cannot be read"}};
  if (!file.contains("scans"))
    return {{name, file["format"], "", size_of_box(file), "", joined_notes(file["warnings"])}};
  std::vector<InfoRow> rows;
  const bool several = file["scans"].size() > 1;
  for (std::size_t k = 0; k < file["scans"].size(); ++k) {
    const Json& scan = file["scans"][k];
    rows.push_back({scan_name(NumberedScan{name, static_cast<int>(k), several}), first_words(file["format"]),
                    fmt::to_string(scan["points"].get<std::size_t>()), size_of_box(scan), place_words(scan),
                    k == 0 ? joined_notes(file["notes"]) : ""});
  }
  return rows;
}

}  // namespace

std::string info_table(const Json& files) {
  std::vector<InfoRow> rows = {{"file", "format", "points", "size, m", "scanner", "notes"}};
  for (const Json& file : files) {
    for (InfoRow& row : rows_of(file)) rows.push_back(std::move(row));
  }
  std::array<std::size_t, kInfoColumns> widths{};
  for (const InfoRow& row : rows) {
    for (std::size_t k = 0; k < kInfoColumns; ++k) widths[k] = std::max(widths[k], width_of(row[k]));
  }
  constexpr std::size_t kPoints = 2;  // numbers stand under one another by their last digit
  std::string text;
  for (const InfoRow& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < kInfoColumns; ++k) {
      const std::string blanks(widths[k] - width_of(row[k]), ' ');
      line += (k == kPoints ? blanks + row[k] : row[k] + blanks) + "  ";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace limen
