// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/control/control_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/table_cells.h"
#include "limen/files/text_numbers.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr const char* kControlRemedy =
    "the first line names the columns: name,x,y,z and sigma, or sigma_x,sigma_y,sigma_z, or cov_xx,cov_xy,"
    "cov_xz,cov_yy,cov_yz,cov_zz; metres";
constexpr const char* kPositionsRemedy =
    "the first line names the columns: file,x,y,z and, if known, sigma, or sigma_x,sigma_y,sigma_z; metres";
constexpr double kPositionSigmaM = 1.0;  // satellites near buildings, a tablet's track

/// One row of a table, with what an error has to name.
class Row {
 public:
  Row(const std::map<std::string, std::size_t>& columns, std::vector<std::string> cells, char mark,
      std::string where, const char* remedy)
      : columns_(columns), cells_(std::move(cells)), mark_(mark), where_(std::move(where)), remedy_(remedy) {}

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] bool has(const std::string& column) const { return columns_.count(column) > 0; }

  [[nodiscard]] const std::string& text(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end()) throw Error("there is no column " + column, where_, remedy_);
    if (found->second >= cells_.size() || cells_[found->second].empty())
      throw Error("there is nothing in the column " + column, where_, "fill it, or take the line out");
    return cells_[found->second];
  }

  [[nodiscard]] double number(const std::string& column) const {
    std::string cell = text(column);
    if (mark_ == ';') std::replace(cell.begin(), cell.end(), ',', '.');
    const std::optional<double> value = parse_number(cell);
    if (!value || !std::isfinite(*value))
      throw Error(fmt::format("\"{}\" in the column {} is not a number", cell, column), where_, remedy_);
    return *value;
  }

  /// Nothing where there is no such column, or nothing in it.
  [[nodiscard]] std::optional<double> number_if_any(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end() || found->second >= cells_.size() || cells_[found->second].empty()) return {};
    return number(column);
  }

  [[nodiscard]] double sigma(const std::string& column) const {
    const double value = number(column);
    if (value <= 0.0)
      throw Error(fmt::format("the standard deviation {} in the column {} is not above 0", value, column),
                  where_, "give one standard deviation in metres, above 0");
    return value;
  }

  [[nodiscard]] Vector3d place() const { return {number("x"), number("y"), number("z")}; }

  [[nodiscard]] Matrix3d covariance() const {
    if (has("cov_xx")) return full_covariance();
    if (has("sigma_x")) {
      const Vector3d sigmas(sigma("sigma_x"), sigma("sigma_y"), sigma("sigma_z"));
      return sigmas.array().square().matrix().asDiagonal();
    }
    const double own = sigma("sigma");
    return own * own * Matrix3d::Identity();
  }

 private:
  [[nodiscard]] Matrix3d full_covariance() const {
    const double xy = number("cov_xy");
    const double xz = number("cov_xz");
    const double yz = number("cov_yz");
    Matrix3d full;
    full << number("cov_xx"), xy, xz, xy, number("cov_yy"), yz, xz, yz, number("cov_zz");
    const Vector3d variances = spectrum_of(full).values;
    // Below this no inverse of it means anything.
    constexpr double kLeastShare = 1e-12;
    if (variances[0] <= kLeastShare * std::abs(variances[2]))
      throw Error("the covariance is not positive definite", where_,
                  "check its six numbers, or give sigma_x,sigma_y,sigma_z");
    return full;
  }

  const std::map<std::string, std::size_t>& columns_;
  std::vector<std::string> cells_;
  char mark_;
  std::string where_;
  const char* remedy_;
};

/// Calls `visit` with each row of the table, which has to have a column `key`.
template <typename Visit>
void read_table(const std::filesystem::path& path, const std::string& key, const char* remedy,
                const Visit& visit) {
  const TextTable table = read_text_table(path);
  if (table.columns.line == 0) throw Error("holds no line", path.string(), remedy);
  const auto where = [&](const TableRow& row) { return fmt::format("{}, line {}", path.string(), row.line); };
  std::map<std::string, std::size_t> columns;
  for (std::size_t k = 0; k < table.columns.cells.size(); ++k) {
    const std::string& name = table.columns.cells[k];
    if (!columns.emplace(lower_case(name), k).second && !name.empty())
      throw Error("two columns are called " + name, where(table.columns), remedy);
  }
  if (columns.count(key) == 0) throw Error("no column is called " + key, where(table.columns), remedy);
  std::string given;
  for (const char* const deviation : {"sigma", "sigma_x", "cov_xx"}) {
    if (columns.count(deviation) == 0) continue;
    if (!given.empty())
      throw Error(fmt::format("there are columns {} and {}, which state the same", given, deviation),
                  where(table.columns), "take one of them out");
    given = deviation;
  }
  for (const TableRow& row : table.rows) visit(Row(columns, row.cells, table.mark, where(row), remedy));
}

/// Points called by their column `key`, each once. `sigma_m`: where the table has no column of deviations.
std::vector<SurveyedPoint> read_points(const std::filesystem::path& path, const std::string& key,
                                       const char* remedy, std::optional<double> sigma_m) {
  std::vector<SurveyedPoint> points;
  std::set<std::string> known;
  read_table(path, key, remedy, [&](const Row& row) {
    const bool stated = !sigma_m || row.has("sigma") || row.has("sigma_x") || row.has("cov_xx");
    points.push_back({row.text(key), row.place(),
                      stated ? row.covariance() : Matrix3d(*sigma_m * *sigma_m * Matrix3d::Identity())});
    if (!known.insert(points.back().name).second)
      throw Error((key == "name" ? "the point " : "") + points.back().name + " is given twice", row.where(),
                  "take one of them out");
  });
  if (points.empty()) throw Error("no row follows the names of the columns", path.string(), remedy);
  return points;
}

}  // namespace

std::vector<SurveyedPoint> read_surveyed_points(const std::filesystem::path& path) {
  return read_points(path, "name", kControlRemedy, std::nullopt);
}

std::vector<SeenTarget> read_seen_targets(const std::filesystem::path& path) {
  std::vector<SeenTarget> targets;
  std::set<std::tuple<std::string, std::string, std::optional<double>>> known;
  read_table(path, "name", kControlRemedy, [&](const Row& row) {
    targets.push_back(
        {row.text("name"), row.text("scan"), row.place(), row.covariance(), row.number_if_any("time")});
    if (!known.emplace(targets.back().name, targets.back().scan, targets.back().time_s).second)
      throw Error(fmt::format("the scan {} sees {} twice", targets.back().scan, targets.back().name),
                  row.where(),
                  "take one of them out, or add a column time with the time at which a mobile scan saw each");
  });
  return targets;
}

std::vector<SurveyedPoint> read_stated_positions(const std::filesystem::path& path) {
  return read_points(path, "file", kPositionsRemedy, kPositionSigmaM);
}

}  // namespace limen
