// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/mapped_file.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/system.h"
#include "limen/base/text.h"

namespace limen {
namespace {

struct VendorFormat {
  std::string_view endings;  ///< each with a blank behind it
  const char* what;
  const char* remedy;
};

constexpr std::array<VendorFormat, 12> kVendors{{
    {".fls .lsproj .fws ", "FARO scan data", "open it in FARO SCENE and export the scans as E57"},
    {".rcp .rcs .pcg ", "Autodesk ReCap data", "open it in ReCap Pro and choose Export, E57"},
    {".zfs .zfprj ", "Zoller + Fröhlich scan data",
     "open it in Z+F LaserControl and export the scans as E57"},
    {".ptg .imp .lgs .lgsx .b2g ", "Leica Geosystems scan data",
     "open it in Cyclone or Cyclone REGISTER 360 and export the setups as E57"},
    {".rxp .rsp .rdb .rdbx .3dd ", "RIEGL scan data",
     "open it in RiSCAN PRO and export the scan positions as E57"},
    {".tzf .tzs .rwp .rwcx ", "Trimble scan data",
     "open it in Trimble RealWorks and export the stations as E57"},
    {".clr .cl3 ", "Topcon scan data", "open it in MAGNET Collage or ScanMaster and export the scans as E57"},
    {".dp ", "DotProduct scan data", "open it in Dot3D and export it as E57"},
    {".pod ", "Bentley Pointools data", "open it in Pointools or MicroStation and export it as E57"},
    {".rvt .rfa ", "an Autodesk Revit model", "open it in Revit and choose File, Export, IFC"},
    {".nwd .nwc .nwf ", "an Autodesk Navisworks model",
     "export the model as IFC4 from the program that made it"},
    {".pln .pla ", "a Graphisoft Archicad model", "open it in Archicad and save it as IFC4"},
}};
constexpr std::string_view kLeicaPtg{"PTG\0\xC7\xA3\x8F\x92", 8};

const VendorFormat* vendor_of(const std::string& ending) {
  const auto* const found = std::find_if(kVendors.begin(), kVendors.end(), [&](const VendorFormat& vendor) {
    return vendor.endings.find(ending + " ") != std::string_view::npos;
  });
  return ending.empty() || found == kVendors.end() ? nullptr : found;
}

}  // namespace

bool has_vendor_ending(const std::filesystem::path& path) {
  return vendor_of(lower_case(path.extension().string())) != nullptr;
}

void refuse_vendor_format(std::string_view bytes, const std::filesystem::path& path) {
  const bool ptg = bytes.substr(0, kLeicaPtg.size()) == kLeicaPtg;
  const std::string ending = ptg ? ".ptg" : lower_case(path.extension().string());
  const VendorFormat* const vendor = vendor_of(ending);
  if (vendor == nullptr) return;
  throw Error(fmt::format("is {} ({}), which only its maker's programs read", vendor->what, ending),
              path.string(), vendor->remedy);
}

Error missing_file(const std::string& name) {
  if (name.empty()) return {"the name of a file is empty", "", "name a file"};
  if (name.find("://") != std::string::npos)
    return {"is a web address, but limen reads files only", name, "download it, and name the file"};
  return {"there is no such file", name, "check the path"};
}

std::string why_no_file(unsigned mode, const char* wanted) {
  if (S_ISREG(mode)) return {};
  return fmt::format("is a {}, not a {}", S_ISDIR(mode) ? "folder" : "pipe or a device", wanted);
}

std::string why_unreadable(const std::filesystem::path& path, const char* wanted) {
  const unsigned mode = mode_of(path);
  if (mode == 0)
    return errno == ENOENT || errno == ENOTDIR ? missing_file(path.string()).problem() : reason_of(errno);
  if (std::string other = why_no_file(mode, wanted); !other.empty()) return other;
  return may_read(path) ? "" : reason_of(errno);
}

void require_readable(const std::filesystem::path& path, const std::string& remedy, const char* wanted) {
  const std::string why = why_unreadable(path, wanted);
  if (!why.empty()) throw Error(why, path.string(), remedy);
}

namespace {

class Descriptor {
 public:
  /// Does not wait for who writes to a pipe.
  explicit Descriptor(const std::string& name) : value_(open_to_read(name)) {
    if (value_ >= 0) return;
    const int reason = errno;
    if (reason == ENOENT || reason == ENOTDIR) throw missing_file(name);
    throw Error("cannot be opened: " + reason_of(reason), name, "check the path and its permissions");
  }
  ~Descriptor() { close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_;
};

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(path, ignored);
  if (folder) refuse_vendor_format({}, path);
  if (folder) throw Error(why_no_file(S_IFDIR), name, "name the file in it");
  const Descriptor file(name);
  struct stat status {};
  if (fstat(file.value(), &status) != 0) {
    throw Error("cannot be examined: " + reason_of(errno), name, "check the path and its permissions");
  }
  if (const std::string other = why_no_file(status.st_mode); !other.empty())
    throw Error(other, name, "write it to a file, and name that");
  if (status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    const int kept = duplicate(file.value());
    if (kept >= 0) mapping_ = std::make_unique<const GuardedMapping>(kept, size_, name);
    if (mapping_) data_ = mapping_->data();
  }
  if (data_ == nullptr) read_whole(file.value(), name);
  if (size_ == 0) throw Error("the file is empty", name, "check how it was written or copied");
}

void MappedFile::read_whole(int descriptor, const std::string& name) {
  read_.resize(size_);
  std::size_t there = 0;
  while (there < size_) {
    const std::ptrdiff_t got = read_some(descriptor, read_.data() + there, size_ - there);
    if (got < 0 && errno != EINTR)
      throw Error("cannot be read: " + reason_of(errno), name, "check the file and its disk");
    if (got == 0) break;
    there += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  read_.resize(there);
  data_ = read_.data();
  size_ = read_.size();
}

}  // namespace limen
