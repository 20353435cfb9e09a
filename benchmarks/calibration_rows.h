// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What one pair gave, as a line of text, and what many of them say together.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limen::calibration {

/// A stated probability and whether the pose it was stated of is the true one.
struct Statement {
  double probability = 0.0;
  bool right = false;
};

/// One pair.
struct Row {
  std::string building;
  std::string purpose;
  std::uint64_t seed = 0;
  std::string source;
  std::string target;
  std::string kind;  ///< of the pair
  bool mirrored = false;
  bool furnished_alike = false;
  bool same_storey = true;
  std::string outcome;
  bool near = false;    ///< the best pose is the true one
  bool listed = false;  ///< or an alternative
  double rotation_deg = 0.0;
  double translation_m = 0.0;
  double agreeing_m2 = 0.0;
  double contradicted_m2 = 0.0;
  double seconds = 0.0;
  std::vector<Statement> statements;  ///< of every hypothesis of which a probability was stated

  [[nodiscard]] bool registered() const { return outcome == "registered"; }
  [[nodiscard]] bool wrong() const { return registered() && !near; }
  /// Whether the two scans have a room in common, or one that a door joins: then there is a pose to be found.
  [[nodiscard]] bool joined() const {
    return kind == "same_room" || kind == "other_day" || kind == "next_room";
  }
};

inline std::string header() {
  return "building,purpose,seed,source,target,kind,mirrored,furnished_alike,same_storey,outcome,near,listed,"
         "rotation_deg,translation_m,agreeing_m2,contradicted_m2,seconds,statements";
}

inline std::string text_of(const Row& row) {
  std::vector<std::string> statements;
  for (const Statement& s : row.statements)
    statements.push_back(fmt::format("{:.6g}:{:d}", s.probability, s.right));
  return fmt::format("{},{},{},{},{},{},{:d},{:d},{:d},{},{:d},{:d},{:.4f},{:.4f},{:.2f},{:.2f},{:.2f},{}",
                     row.building, row.purpose, row.seed, row.source, row.target, row.kind, row.mirrored,
                     row.furnished_alike, row.same_storey, row.outcome, row.near, row.listed,
                     row.rotation_deg, row.translation_m, row.agreeing_m2, row.contradicted_m2, row.seconds,
                     fmt::join(statements, ";"));
}

inline Row row_of(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  fields.resize(18);
  Row row;
  row.building = fields[0];
  row.purpose = fields[1];
  row.seed = std::stoull(fields[2]);
  row.source = fields[3];
  row.target = fields[4];
  row.kind = fields[5];
  row.mirrored = fields[6] == "1";
  row.furnished_alike = fields[7] == "1";
  row.same_storey = fields[8] == "1";
  row.outcome = fields[9];
  row.near = fields[10] == "1";
  row.listed = fields[11] == "1";
  row.rotation_deg = std::stod(fields[12]);
  row.translation_m = std::stod(fields[13]);
  row.agreeing_m2 = std::stod(fields[14]);
  row.contradicted_m2 = std::stod(fields[15]);
  row.seconds = std::stod(fields[16]);
  std::stringstream statements(fields[17]);
  for (std::string one; std::getline(statements, one, ';');)
    row.statements.push_back({std::stod(one), one.back() == '1'});
  return row;
}

/// Rows of a file that an earlier run wrote; none where there is no such file.
inline std::vector<Row> rows_of(const std::string& path) {
  std::vector<Row> rows;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line))
    if (!line.empty()) rows.push_back(row_of(line));
  return rows;
}

/// How often each outcome came out of one kind of pair.
struct Count {
  int pairs = 0, right = 0, wrong = 0, probable = 0, ambiguous = 0, listed = 0, under_constrained = 0,
      no_match = 0;
  void add(const Row& row) {
    ++pairs;
    right += row.registered() && row.near ? 1 : 0;
    wrong += row.wrong() ? 1 : 0;
    probable += row.outcome == "probable" ? 1 : 0;
    ambiguous += row.outcome == "ambiguous" ? 1 : 0;
    listed += row.outcome == "ambiguous" && row.listed ? 1 : 0;
    under_constrained += row.outcome == "under_constrained" ? 1 : 0;
    no_match += row.outcome == "no_match" ? 1 : 0;
  }
};

inline void print_counts(const char* title, const std::map<std::string, Count>& counts) {
  fmt::print("\n{:<44} {:>5} {:>6} {:>6} {:>9} {:>10} {:>7} {:>6} {:>9}\n", title, "pairs", "right", "WRONG",
             "probable", "ambiguous", "listed", "under", "no match");
  for (const auto& [name, c] : counts)
    fmt::print("{:<44} {:>5} {:>6} {:>6} {:>9} {:>10} {:>7} {:>6} {:>9}\n", name, c.pairs, c.right, c.wrong,
               c.probable, c.ambiguous, c.listed, c.under_constrained, c.no_match);
}

/// Stated probabilities against the share that was right, in ten bins.
struct Reliability {
  struct Bin {
    int count = 0, right = 0;
    double stated = 0.0;
  };
  std::vector<Bin> bins = std::vector<Bin>(10);
  int count = 0;

  void add(const Statement& statement) {
    const double p = std::clamp(statement.probability, 0.0, 1.0);
    Bin& bin = bins[std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * p))];
    ++bin.count;
    ++count;
    bin.right += statement.right ? 1 : 0;
    bin.stated += p;
  }

  /// Mean distance of stated and true share, each bin by its count.
  [[nodiscard]] double expected_error() const {
    double sum = 0.0;
    for (const Bin& bin : bins) sum += std::abs(bin.stated - bin.right);
    return count > 0 ? sum / count : 0.0;
  }

  void print() const {
    fmt::print("\nstated P       count  mean P  right  within 95 %\n");
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const Bin& bin = bins[i];
      if (bin.count == 0) continue;
      const double p = bin.stated / bin.count;
      const double share = static_cast<double>(bin.right) / bin.count;
      const double band = 1.96 * std::sqrt(p * (1.0 - p) / bin.count) + 0.5 / bin.count;
      fmt::print("{:.1f} to {:.1f}  {:>8} {:>7.3f} {:>6.3f}  {}\n", 0.1 * static_cast<double>(i),
                 0.1 * static_cast<double>(i + 1), bin.count, p, share,
                 std::abs(p - share) <= band ? "yes" : "no");
    }
    fmt::print("expected calibration error {:.4f} over {} statements\n", expected_error(), count);
  }

  /// A picture of the table: bars where bins hold something, the diagonal for what should be.
  [[nodiscard]] std::string svg() const {
    std::string text =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 460 440\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n"
        "<rect width=\"460\" height=\"440\" fill=\"white\"/>\n<g fill=\"none\" stroke=\"#bbb\">\n";
    for (int i = 0; i <= 10; i += 2)
      text += fmt::format("<path d=\"M60 {0}H440\"/><path d=\"M{1} 20V400\"/>\n", 400 - 38 * i, 60 + 38 * i);
    text += "</g>\n<path d=\"M60 400L440 20\" stroke=\"#888\" stroke-dasharray=\"5 4\"/>\n";
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const Bin& bin = bins[i];
      if (bin.count == 0) continue;
      const double share = static_cast<double>(bin.right) / bin.count;
      const double p = bin.stated / bin.count;
      const double band = 380.0 * 1.96 * std::sqrt(std::max(p * (1.0 - p), 0.25 / bin.count) / bin.count);
      const double x = 60.0 + 380.0 * p;
      const double y = 400.0 - 380.0 * share;
      text += fmt::format(
          "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#5b8\" stroke-width=\"7\" opacity=\"0.5\"/>\n", x,
          std::max(20.0, 400.0 - 380.0 * p - band), std::min(400.0, 400.0 - 380.0 * p + band));
      text += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"#124\"/><text x=\"{:.1f}\" "
          "y=\"{:.1f}\">{}</text>\n",
          x, y, x + 8.0, y + (y < 60.0 ? 18.0 : -6.0), bin.count);
    }
    for (int i = 0; i <= 10; i += 2)
      text += fmt::format(
          "<text x=\"{0}\" y=\"418\" text-anchor=\"middle\">{2}</text><text x=\"52\" y=\"{1}\" "
          "text-anchor=\"end\">{2}</text>\n",
          60 + 38 * i, 404 - 38 * i, 0.1 * i);
    return text +
           "<text x=\"250\" y=\"436\" text-anchor=\"middle\">stated probability</text><text x=\"16\" "
           "y=\"210\" "
           "text-anchor=\"middle\" transform=\"rotate(-90 16 210)\">share that was right</text>\n</svg>\n";
  }
};

}  // namespace limen::calibration
