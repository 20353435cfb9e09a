// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/extract_features.h"

#include <utility>

namespace limen {

void ExtractOptions::check() const {
  grow.check();
  polygons.check();
  samples.check();
}

ExtractedFeatures extract_features(const Scan& scan, const ExtractOptions& options, Monitor& monitor) {
  options.check();
  GrownPlanes grown = grow_planes(scan, options.grow, monitor);
  ExtractedFeatures extracted;
  Features& features = extracted.features;
  features.local_origin = scan.local_origin;
  features.noise_m = grown.noise_m;
  features.inlier_threshold_m = grown.inlier_threshold_m;
  features.planes = make_polygons(scan, grown.planes, options.polygons, monitor);
  features.samples = sample_surface(scan, grown.planes, features.planes, options.samples);
  extracted.labels = std::move(grown.planes.labels);
  return extracted;
}

}  // namespace limen
