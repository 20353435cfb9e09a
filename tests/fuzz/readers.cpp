// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "readers.h"

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/bim/ifc/ifc_stream.h"
#include "limen/bim/ifc/ifc_structure.h"
#include "limen/bim/ifc/step_file.h"
#include "limen/bim/mesh/read_mesh.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/serve/http_request.h"
#include "limen/files/zip.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_copy.h"
#include "limen/io/e57/e57_crc.h"
#include "limen/io/e57/e57_poses.h"
#include "limen/io/las/las.h"
#include "limen/io/pcd/pcd.h"
#include "limen/io/ply/ply.h"
#include "limen/io/ptx/ptx.h"
#include "limen/io/text/read_segments.h"
#include "limen/io/text/text.h"
#include "limen/io/trajectory/read_trajectory.h"
#include "limen/report/pose_file.h"

namespace limen {
namespace {

constexpr const char* kName = "strange";

/// A file in memory, for readers that take a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(memfd_create(kName, MFD_CLOEXEC)) {
    while (!bytes.empty()) {
      const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
      if (written <= 0) throw Error("no room for a file in memory", kName, "free memory", Fault::internal);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Does what may throw Error for the input.
template <typename Action>
void may_fail(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
  }
}

void check(const ScanFile& file) {
  for (const Scan& scan : file.scans) scan.check();
}

/// All clouds of a file, piece by piece. What says that it holds very many points need not be read to its
/// end.
void read_clouds(const PointFile& file) {
  constexpr std::size_t kRows = 300;
  constexpr int kMostPieces = 200;
  for (std::size_t i = 0; i < file.clouds().size() && i < 20; ++i) {
    const auto stream = file.read(i);
    for (int piece = 0; piece < kMostPieces; ++piece) {
      const auto rows = stream->next(kRows);
      if (!rows) break;
      std::vector<double> numbers(rows->rows);
      for (const Field& field : rows->fields) load_numbers(*rows, field, {0, rows->rows}, numbers.data());
      if (rows->rows > 0) may_fail([&] { with_scan({}, *rows, file.clouds()[i].table, {}); });
    }
  }
}

void ply(std::string_view bytes) {
  may_fail([&] { read_clouds(*open_ply(bytes, kName)); });
  check(read_ply(bytes, kName));
}
void pcd(std::string_view bytes) {
  may_fail([&] { read_clouds(*open_pcd(bytes, kName)); });
  check(read_pcd(bytes, kName));
}
void ptx(std::string_view bytes) {
  may_fail([&] { read_clouds(*open_ptx(bytes, kName)); });
  check(read_ptx(bytes, kName));
}
void xyz(std::string_view bytes) {
  may_fail([&] { read_clouds(*open_xyz(bytes, kName)); });
  check(read_xyz(bytes, kName));
}

/// With check sums that are right, so that what lies behind them is reached.
std::string with_check_sums(std::string_view bytes) {
  constexpr std::size_t kPage = 1024;
  constexpr std::size_t kSum = 4;
  std::string sound(bytes);
  for (std::size_t page = 0; page + kPage <= sound.size(); page += kPage) {
    const std::uint32_t sum = crc32c(std::string_view(sound).substr(page, kPage - kSum));
    for (std::size_t k = 0; k < kSum; ++k)
      sound[page + kPage - 1 - k] = static_cast<char>((sum >> (8 * k)) & 255U);
  }
  return sound;
}

void e57(std::string_view bytes) {
  may_fail([&] { read_clouds(*open_e57(bytes, kName)); });
  const std::string sound = with_check_sums(bytes);
  may_fail([&] { replace_e57_poses(sound, kName, {}, "/dev/null"); });
  may_fail([&] {
    E57PageWriter copy("/dev/null");
    const E57Original original(sound, kName);
    for (std::size_t k = 0; k < original.document().scans.size(); ++k) original.copy(k, {}, copy);
  });
  read_clouds(*open_e57(sound, kName));
}
void las(std::string_view bytes) {
  may_fail([&] { transform_las(bytes, kName, {}, "/dev/null"); });
  read_clouds(*open_las(bytes, kName));
}

/// Up to the finished model, faces merged: the long way of a mesh.
void mesh(std::string_view bytes) {
  if (!looks_like_obj(bytes) && !looks_like_mesh_ply(bytes)) return;
  const MemoryFile file(bytes);
  read_bim(file.path());
}

void step(std::string_view bytes) {
  const StepFile file(bytes);
  const IfcStructure structure = read_ifc_structure(file);
  for (const StepEntity& entity : file.entities()) with_parts(structure, entity.id);
}

void ifc_shapes(std::string_view bytes) {
  parse_ifc_stream(bytes);
}

void zip(std::string_view bytes) {
  constexpr std::size_t kMost = 1 << 20;
  for (const ZipMember& member : zip_members(bytes)) unpacked(bytes, member, kName, kMost);
}

void segments(std::string_view bytes) {
  const MemoryFile file(bytes);
  is_segment_file(file.path());
  read_segments(file.path());
}

/// As the content says, and as a text of named columns.
void trajectory(std::string_view bytes) {
  const MemoryFile file(bytes);
  may_fail([&] { read_trajectory(file.path()); });
  TrajectoryOptions named;
  named.columns = {"time", "x", "y", "z", "roll", "pitch", "heading"};
  named.lever_arm_m = {0.1, 0.2, -0.3};
  read_trajectory(file.path(), named);
}

void pose(std::string_view bytes) {
  const MemoryFile file(bytes);
  PoseFile result;
  result.source_path = "a.ply";
  result.target_path = "b.ply";
  may_fail([&] { read_true_pose(file.path(), result); });
  read_pose_file(file.path());
}

/// The head of a request to `limen serve`, as it comes off the network.
void http(std::string_view bytes) {
  try {
    const HttpRequest request = parse_http_head(bytes);
    for (const auto& [name, value] : request.fields) static_cast<void>(request.field(name));
  } catch (const HttpFault&) {
    return;  // stated to its sender
  }
}

}  // namespace

const std::vector<FuzzedReader>& fuzzed_readers() {
  static const std::vector<FuzzedReader> kReaders{
      {"ply", ply},   {"pcd", pcd},
      {"ptx", ptx},   {"xyz", xyz},
      {"e57", e57},   {"las", las},
      {"laz", las},   {"mesh", mesh},
      {"step", step}, {"ifc_shapes", ifc_shapes},
      {"zip", zip},   {"segments", segments},
      {"pose", pose}, {"trajectory", trajectory},
      {"http", http},
  };
  return kReaders;
}

double seconds_allowed(std::size_t bytes) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__clang__)
  constexpr double kSlower = 20.0;  // sanitizers; the fuzzers are built with clang
#else
  constexpr double kSlower = 1.0;
#endif
  return kSlower * (0.25 + 4e-6 * static_cast<double>(bytes));
}

void read_strange(const FuzzedReader& reader, std::string_view bytes) {
  const std::clock_t begin = std::clock();  // computing, of all threads: others on the machine do not count
  may_fail([&] { reader.read(bytes); });
  const double taken_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (taken_s <= seconds_allowed(bytes.size())) return;
  throw std::runtime_error("the reader " + std::string(reader.name) + " computed " + std::to_string(taken_s) +
                           " s for " + std::to_string(bytes.size()) + " bytes");
}

}  // namespace limen
