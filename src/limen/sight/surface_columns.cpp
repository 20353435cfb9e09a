// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/surface_columns.h"

namespace limen {

void SurfaceColumns::reserve(std::size_t count) {
  for (std::vector<float>* column : {&x, &y, &z, &nx, &ny, &nz, &oriented}) column->reserve(count);
  planar.reserve(count);
}

void SurfaceColumns::add(const SurfaceSample& sample, bool oriented_plane) {
  x.push_back(static_cast<float>(sample.mean.x()));
  y.push_back(static_cast<float>(sample.mean.y()));
  z.push_back(static_cast<float>(sample.mean.z()));
  const bool on_plane = sample.plane >= 0;
  nx.push_back(on_plane ? static_cast<float>(sample.normal.x()) : 0.0F);
  ny.push_back(on_plane ? static_cast<float>(sample.normal.y()) : 0.0F);
  nz.push_back(on_plane ? static_cast<float>(sample.normal.z()) : 0.0F);
  planar.push_back(on_plane ? 1 : 0);
  oriented.push_back(on_plane && oriented_plane ? 1.0F : 0.0F);
}

void SurfaceColumns::add(const Features& scan, std::size_t i) {
  const SurfaceSample& sample = scan.samples[i];
  add(sample, sample.plane >= 0 && scan.planes[static_cast<std::size_t>(sample.plane)].oriented);
}

}  // namespace limen
