// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/vendor_format.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "limen/base/error.h"
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

}  // namespace limen
