// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// What is found out about the scanner's position of static scans whose true one is known.
//   bench_scanner_places scans.list --moves 10
// Each line of the list: SET FILE X Y Z, the true position in the coordinates of the file.
//
// - estimated: no position is stated. How many are found, within 10 cm of the truth, and within three of the
//   stated standard deviations per axis.
// - true kept: the true position is stated, as 0,0,0 is that many files have.
// - false kept: the points were moved by 2 to 8 m in an export, so that a false one is stated. Only those
// count
//   that reading does not drop already.
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/table/optical_centre.h"
#include "limen/register/frame/scan_frame.h"

namespace {

using namespace limen;

struct Counts {
  int scans = 0;
  int found = 0;
  int near = 0;
  int within = 0;
  int true_kept = 0;
  int false_claims = 0;
  int false_kept = 0;
};

ScannerPlace place_of(Scan& scan, const Vector3d* claim) {
  scan.centres.clear();
  if (claim != nullptr) scan.centres = {*claim};
  scan.centre_source = PlaceSource::assumed;
  return find_scan_frame(scan, Gravity::automatic).place;
}

void count_estimate(const ScannerPlace& place, const Vector3d& truth, Counts& counts) {
  if (place.source != PlaceSource::estimated) return;
  const Vector3d off = place.centre - truth;
  ++counts.found;
  counts.near += off.norm() < 0.1 ? 1 : 0;
  counts.within += off.cwiseAbs().maxCoeff() < 3.0 * place.sigma_m.value_or(0.0) ? 1 : 0;
}

void count_scan(Scan& scan, const Vector3d& truth, int moves, RandomStream& random, Counts& counts) {
  ++counts.scans;
  count_estimate(place_of(scan, nullptr), truth, counts);
  counts.true_kept += place_of(scan, &truth).source == PlaceSource::assumed ? 1 : 0;
  for (int k = 0; k < moves; ++k) {
    const double metres = random.uniform(2.0, 8.0);
    const Vector3d claim = truth + metres * vector_in_ball(random).normalized();
    if (!can_be_scanner(scan.points, claim)) continue;
    ++counts.false_claims;
    counts.false_kept += place_of(scan, &claim).source == PlaceSource::assumed ? 1 : 0;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What is found out about the scanner's position");
  std::string list;
  int moves = 10;
  app.add_option("list", list)->required()->check(CLI::ExistingFile);
  app.add_option("--moves", moves);
  CLI11_PARSE(app, argc, argv);
  std::map<std::string, Counts> sets;
  std::ifstream file(list);
  RandomStream random(1);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string set;
    std::string cloud;
    Vector3d truth;
    words >> set >> cloud >> truth.x() >> truth.y() >> truth.z();
    Scan scan = read_scan(cloud);
    count_scan(scan, truth - scan.local_origin, moves, random, sets[set]);
  }
  fmt::print("| set | scans | estimated | within 10 cm | within 3 sigma | true kept | false kept |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const auto& [set, n] : sets)
    fmt::print("| {} | {} | {} | {} | {} | {} | {} of {} |\n", set, n.scans, n.found, n.near, n.within,
               n.true_kept, n.false_kept, n.false_claims);
}
