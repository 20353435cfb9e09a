// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/segment.h"
#include "limen/simulate/recipes.h"
#include "limen/simulate/scanner/ray_caster.h"

// The true edges of a simulated building, and which of them a scan saw. The words are defined in
// segment_quality_main.cpp.

namespace limen {

struct EdgeTruthOptions {
  double step_m = 0.02;         ///< between the samples of an edge
  double echo_along_m = 0.1;    ///< echoes are counted this far along the edge, to either side,
  double echo_across_m = 0.05;  ///< and this far into the face
  int min_echoes = 4;           ///< in that strip
  int min_border_echoes = 25;   ///< the same where one face alone shows the edge: 2 cm apart
  int min_face_echoes = 200;    ///< of a face, in all
  double min_width_m = 0.06;    ///< of a face next to the edge; narrower ones are distinguished
  double min_angle_deg = 15.0;  ///< between two faces that make a crease
  double min_relief_m = 0.02;   ///< between parallel faces that make a step
  double gap_m = 0.1;           ///< unseen stretches up to this do not cut an edge
  double min_length_m = 0.5;    ///< of an edge that must be found
};

/// All planar faces of the mesh that look one way and lie in one plane, in the coordinates of the scan's
/// points.
struct TrueFace {
  Plane plane;
  PlaneFrame frame;
  std::vector<Polygon> outline;
  Box2 box;
  std::string element;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> echoes;  ///< by cells of 0.1 m
  std::size_t echo_count = 0;
};

/// A sample of an edge of which the scan saw enough.
struct SeenSample {
  Vector3d at = Vector3d::Zero();
  Vector3d along = Vector3d::UnitX();
  bool crease = false;  ///< both faces were seen
  bool sharp = false;   ///< wide faces; a crease, or a border with min_border_echoes
  std::string element;
  Plane face;                         ///< one that was seen
  std::vector<std::uint32_t> echoes;  ///< of it, next to the edge
};

struct EdgeTruth {
  std::vector<Segment> edges;    ///< all, seen or not, of faces with echoes
  std::vector<SeenSample> seen;  ///< of edges that must be found; each is step_m of edge
};

/// Finds the edges of a scan's world, in the coordinates of its points.
class EdgeTruthFinder {
 public:
  EdgeTruthFinder(const SimulatedCase& simulated, std::size_t scan, const World& world,
                  const EdgeTruthOptions& options)
      : o_(options),
        scan_(simulated.scans[scan]),
        mesh_(world.mesh),
        merged_(merge_planes(world.mesh)),
        caster_(world.mesh) {
    const ScanTruth& truth = simulated.truth.scans[scan];
    Rigid3 points_from_local = inverse(truth.local_from_scan);
    points_from_local.translation +=
        truth.mobile ? Vector3d(simulated.truth.local_origin - scan_.local_origin) : -scan_.local_origin;
    points_from_scene_ = points_from_local * simulated.truth.local_from_scene;
    scene_from_points_ = inverse(points_from_scene_);
    make_faces(simulated, scan);
  }

  [[nodiscard]] EdgeTruth run() {
    EdgeTruth truth;
    add_outlines(truth.edges);
    add_crossings(truth.edges);
    std::stable_sort(truth.edges.begin(), truth.edges.end(),
                     [](const Segment& a, const Segment& b) { return a.length() > b.length(); });
    for (const Segment& edge : truth.edges) add_seen(edge, truth.seen);
    return truth;
  }

 private:
  static constexpr double kCell_m = 0.1;
  static constexpr double kOn_m = 0.003;
  static constexpr double kAside_m = 0.01;

  static std::int64_t cell_of(double u, double v) {
    return (static_cast<std::int64_t>(std::floor(u / kCell_m)) << 32) +
           static_cast<std::int64_t>(std::floor(v / kCell_m));
  }

  void make_faces(const SimulatedCase& simulated, std::size_t scan) {
    // The truth keeps the planes with echoes in the order of the merged ones.
    std::vector<std::int32_t> face_of_truth(simulated.truth.planes.size(), -1);
    std::size_t next = 0;
    face_of_merged_.assign(merged_.planes.size(), -1);
    for (std::size_t m = 0; m < merged_.planes.size() && next < face_of_truth.size(); ++m) {
      const Plane plane = transformed(simulated.truth.local_from_scene, merged_.planes[m].plane);
      const TruePlane& kept = simulated.truth.planes[next];
      if ((kept.plane.normal - plane.normal).norm() > 1e-12 ||
          std::abs(kept.plane.offset - plane.offset) > 1e-9)
        continue;
      if (kept.inliers[scan] > 0) {
        face_of_truth[next] = static_cast<std::int32_t>(faces_.size());
        face_of_merged_[m] = face_of_truth[next];
        TrueFace face;
        face.plane = transformed(points_from_scene_, merged_.planes[m].plane);
        face.element = to_string(kept.element);
        faces_.push_back(std::move(face));
      }
      ++next;
    }
    if (next != face_of_truth.size())
      throw Error("planes of mesh and truth differ", "benchmark", "", Fault::internal);
    add_triangles();
    const std::vector<std::int32_t>& plane_of_point = simulated.truth.scans[scan].plane_of_point;
    for (std::size_t i = 0; i < plane_of_point.size(); ++i) {
      const std::int32_t f =
          plane_of_point[i] < 0 ? -1 : face_of_truth[static_cast<std::size_t>(plane_of_point[i])];
      if (f < 0) continue;
      TrueFace& face = faces_[static_cast<std::size_t>(f)];
      const Vector2d p = face.frame.to_plane(scan_.points[i]);
      face.echoes[cell_of(p.x(), p.y())].push_back(static_cast<std::uint32_t>(i));
      ++face.echo_count;
    }
  }

  void add_triangles() {
    std::vector<std::vector<Polygon>> pieces(faces_.size());
    std::vector<char> framed(faces_.size(), 0);
    for (std::size_t t = 0; t < mesh_.triangles().size(); ++t) {
      const int surface = mesh_.surface_of_triangle()[t];
      // A thin sheet is two faces.
      for (const int side : {surface, mesh_.surfaces()[static_cast<std::size_t>(surface)].back}) {
        const int merged = side < 0 ? -1 : merged_.plane_of_surface[static_cast<std::size_t>(side)];
        const int f = merged < 0 ? -1 : face_of_merged_[static_cast<std::size_t>(merged)];
        if (f < 0) continue;
        TrueFace& face = faces_[static_cast<std::size_t>(f)];
        Polygon triangle;
        for (const std::uint32_t corner : mesh_.triangles()[t]) {
          const Vector3d x = points_from_scene_ * mesh_.vertices()[corner];
          if (framed[static_cast<std::size_t>(f)] == 0) face.frame = make_frame(face.plane, x);
          framed[static_cast<std::size_t>(f)] = 1;
          triangle.outer.push_back(face.frame.to_plane(x));
        }
        pieces[static_cast<std::size_t>(f)].push_back(triangle);
      }
    }
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      // Triangles meet on the grid of the set operations only up to its step: gaps are closed.
      constexpr double kClose_m = 1e-4;
      faces_[f].outline = simplified(grown(grown(merged(pieces[f]), kClose_m), -kClose_m), 5e-4);
      faces_[f].box = box_of(faces_[f].outline);
    }
  }

  void add_outlines(std::vector<Segment>& edges) const {
    for (const TrueFace& face : faces_) {
      for (const Polygon& part : face.outline) {
        add_ring(face, part.outer, edges);
        for (const Ring& hole : part.holes) add_ring(face, hole, edges);
      }
    }
  }

  static void add_ring(const TrueFace& face, const Ring& ring, std::vector<Segment>& edges) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges.push_back({face.frame.to_space(ring[i]), face.frame.to_space(ring[(i + 1) % ring.size()])});
  }

  /// Where faces run through one another.
  void add_crossings(std::vector<Segment>& edges) const {
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      for (std::size_t j = i + 1; j < faces_.size(); ++j) {
        const Plane& a = faces_[i].plane;
        const Plane& b = faces_[j].plane;
        const Vector3d across = a.normal.cross(b.normal);
        if (across.norm() < std::sin(radians(o_.min_angle_deg))) continue;
        Segment line;
        const double cosine = a.normal.dot(b.normal);
        const Vector3d near = faces_[i].frame.to_space(0.5 * (faces_[i].box.low + faces_[i].box.high));
        const double scale = 1.0 / across.squaredNorm();
        const double da = a.signed_distance(near);
        const double db = b.signed_distance(near);
        line.a = near - scale * (da - db * cosine) * a.normal - scale * (db - da * cosine) * b.normal;
        line.b = line.a + across.normalized();
        for (const auto& [begin, end] : within(faces_[i], line)) {
          for (const auto& [from, to] : within(faces_[j], line)) {
            const double low = std::max(begin, from);
            const double high = std::min(end, to);
            if (high - low < 0.02) continue;
            edges.push_back({line.a + low * (line.b - line.a), line.a + high * (line.b - line.a)});
          }
        }
      }
    }
  }

  /// The stretches of a line in the face's plane that run inside the face.
  static std::vector<std::pair<double, double>> within(const TrueFace& face, const Segment& line) {
    const Vector2d origin = face.frame.to_plane(line.a);
    const Vector2d along = face.frame.to_plane(line.b) - origin;
    const Vector2d across(-along.y(), along.x());
    std::vector<double> cuts;
    for (const Polygon& part : face.outline) {
      cut_ring(part.outer, origin, along, across, cuts);
      for (const Ring& hole : part.holes) cut_ring(hole, origin, along, across, cuts);
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<std::pair<double, double>> inside;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
      if (cuts[k + 1] - cuts[k] > 1e-3 && contains(face, origin + 0.5 * (cuts[k] + cuts[k + 1]) * along))
        inside.emplace_back(cuts[k], cuts[k + 1]);
    return inside;
  }

  static void cut_ring(const Ring& ring, const Vector2d& origin, const Vector2d& along,
                       const Vector2d& across, std::vector<double>& cuts) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2d a = ring[i] - origin;
      const Vector2d b = ring[(i + 1) % ring.size()] - origin;
      const double ha = a.dot(across);
      const double hb = b.dot(across);
      if ((ha < 0.0) == (hb < 0.0)) continue;
      cuts.push_back((a + ha / (ha - hb) * (b - a)).dot(along));
    }
  }

  static bool contains(const TrueFace& face, const Vector2d& p) {
    return std::any_of(face.outline.begin(), face.outline.end(),
                       [&](const Polygon& part) { return limen::contains(part, p); });
  }

  /// A face beside an edge, on one side of it.
  struct Side {
    const TrueFace* face = nullptr;
    Vector3d into = Vector3d::Zero();  ///< unit vector in the face, away from the edge
    Vector3d centre = Vector3d::Zero();
    std::vector<std::uint32_t> echoes = {};
    bool wide = false;  ///< the face reaches min_width_m into
  };

  void add_seen(const Segment& edge, std::vector<SeenSample>& samples) {
    if (edge.length() < o_.min_length_m) return;
    std::vector<const TrueFace*> beside;
    for (const TrueFace& face : faces_) {
      if (face.echo_count < static_cast<std::size_t>(o_.min_face_echoes)) continue;
      if (std::abs(face.plane.signed_distance(edge.a)) < kOn_m &&
          std::abs(face.plane.signed_distance(edge.b)) < kOn_m)
        beside.push_back(&face);
    }
    if (beside.empty()) return;
    std::vector<SeenSample> run;
    double last = -1e9;
    double begin = 0.0;
    const auto finish = [&] {
      if (!run.empty() && last - begin + o_.step_m >= o_.min_length_m) {
        const std::size_t old = samples.size();
        for (const SeenSample& sample : run)
          if (!is_double(sample, samples, old)) keep(sample, samples);
      }
      run.clear();
    };
    for (double t = 0.5 * o_.step_m; t < edge.length(); t += o_.step_m) {
      SeenSample sample;
      sample.at = edge.a + t * edge.direction();
      sample.along = edge.direction();
      if (!seen(beside, sample)) continue;
      if (t - last > o_.gap_m) finish();
      if (run.empty()) begin = t;
      last = t;
      run.push_back(sample);
    }
    finish();
  }

  bool is_double(const SeenSample& sample, const std::vector<SeenSample>& samples, std::size_t size) const {
    for (int step = 0; step < 27; ++step) {
      const Vector3d off = o_.step_m * Vector3d(step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1);
      const auto found = kept_.find(key_of(sample.at + off));
      if (found == kept_.end()) continue;
      for (const std::size_t k : found->second)
        if (k < size && (samples[k].at - sample.at).norm() < 0.6 * o_.step_m &&
            std::abs(samples[k].along.dot(sample.along)) > 0.999)
          return true;
    }
    return false;
  }
  void keep(const SeenSample& sample, std::vector<SeenSample>& samples) {
    kept_[key_of(sample.at)].push_back(samples.size());
    samples.push_back(sample);
  }
  [[nodiscard]] std::uint64_t key_of(const Vector3d& x) const {
    const auto part = [&](double value) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / o_.step_m))) & 0x1fffffU;
    };
    return (part(x.x()) << 42U) | (part(x.y()) << 21U) | part(x.z());
  }

  /// Whether the scan saw the edge there, and how.
  [[nodiscard]] bool seen(const std::vector<const TrueFace*>& beside, SeenSample& sample) const {
    std::vector<Side> sides;
    for (const TrueFace* face : beside) {
      const Vector3d across = face->plane.normal.cross(sample.along).normalized();
      for (const double sign : {1.0, -1.0}) {
        Side side{.face = face, .into = sign * across};
        const Vector3d inside = sample.at + kAside_m * side.into;
        if (!contains(*face, face->frame.to_plane(inside)) || !has_echoes(sample, side)) continue;
        side.wide = contains(*face, face->frame.to_plane(sample.at + o_.min_width_m * side.into));
        if (reaches(side.centre, inside)) sides.push_back(side);
      }
    }
    const double flat = std::cos(radians(o_.min_angle_deg));
    bool goes_on = false;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t j = i + 1; j < sides.size(); ++j) {
        const double cosine = sides[i].into.dot(sides[j].into);
        if (cosine < -flat) {
          goes_on = true;
        } else if (cosine < flat) {
          sample.crease = true;
          sample.sharp = sides[i].wide && sides[j].wide;
          sample.face = sides[i].face->plane;
          sample.echoes = sides[i].echoes;
          sample.element = sides[i].face->element + "/" + sides[j].face->element;
          return true;
        }
      }
    }
    if (sides.empty() || goes_on) return false;
    sample.element = sides[0].face->element;
    sample.face = sides[0].face->plane;
    sample.echoes = sides[0].echoes;
    sample.sharp = sides[0].wide && sides[0].echoes.size() >= static_cast<std::size_t>(o_.min_border_echoes);
    return ends(sides[0], sample.at);
  }

  /// Echoes of the face next to the edge; finds the scanner position of the nearest.
  bool has_echoes(const SeenSample& sample, Side& side) const {
    double nearest = 1e300;
    const Vector2d p = side.face->frame.to_plane(sample.at);
    const int reach = static_cast<int>(std::ceil(o_.echo_along_m / kCell_m));
    for (int du = -reach; du <= reach; ++du) {
      for (int dv = -reach; dv <= reach; ++dv) {
        const auto found = side.face->echoes.find(cell_of(p.x() + du * kCell_m, p.y() + dv * kCell_m));
        if (found == side.face->echoes.end()) continue;
        for (const std::uint32_t i : found->second) {
          const Vector3d off = scan_.points[i] - sample.at;
          const double into = off.dot(side.into);
          if (std::abs(off.dot(sample.along)) > o_.echo_along_m || into < 0.0 || into > o_.echo_across_m)
            continue;
          side.echoes.push_back(i);
          if (off.squaredNorm() >= nearest) continue;
          nearest = off.squaredNorm();
          side.centre = scan_.centre(i);
        }
      }
    }
    return side.echoes.size() >= static_cast<std::size_t>(o_.min_echoes);
  }

  /// The first surface along a ray that is not glass.
  [[nodiscard]] RayHit first_solid(const Vector3d& from, const Vector3d& towards) const {
    const Vector3d origin = scene_from_points_ * from;
    const Vector3d direction = (scene_from_points_ * towards - origin).normalized();
    double begin = 0.05;
    RayHit hit;
    for (int step = 0; step < 12; ++step) {
      hit = caster_.cast(origin, direction, begin);
      if (!hit.found()) return hit;
      const Element element = mesh_.surfaces()[static_cast<std::size_t>(hit.surface)].element;
      if (element != Element::glass && element != Element::portal) return hit;
      begin = hit.range_m + 1e-3;
    }
    return {};
  }

  [[nodiscard]] bool reaches(const Vector3d& centre, const Vector3d& x) const {
    const RayHit hit = first_solid(centre, x);
    return hit.found() && std::abs(hit.range_m - (x - centre).norm()) < 0.005 / std::max(0.1, hit.cosine);
  }

  /// Whether the face is seen to end at an edge.
  [[nodiscard]] bool ends(const Side& side, const Vector3d& at) const {
    const Vector3d beyond = at - kAside_m * side.into;
    const RayHit hit = first_solid(side.centre, beyond);
    if (!hit.found()) return true;
    const Vector3d x = side.centre + hit.range_m * (beyond - side.centre).normalized();
    const double sign = side.face->plane.signed_distance(side.centre) > 0.0 ? 1.0 : -1.0;
    const double before = sign * side.face->plane.signed_distance(x);
    const Vector3d normal =
        points_from_scene_.rotation * mesh_.surfaces()[static_cast<std::size_t>(hit.surface)].plane.normal;
    const bool parallel = std::abs(normal.dot(side.face->plane.normal)) > std::cos(radians(o_.min_angle_deg));
    if (parallel && std::abs(before) < o_.min_relief_m) return false;
    const bool touches = (x - at).norm() < 4.0 * kAside_m + 0.03;
    return before <= 0.0 || touches;
  }

  const EdgeTruthOptions& o_;
  const Scan& scan_;
  const Mesh& mesh_;
  MergedPlanes merged_;
  RayCaster caster_;
  Rigid3 points_from_scene_;
  Rigid3 scene_from_points_;
  std::vector<TrueFace> faces_;
  std::vector<int> face_of_merged_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> kept_;
};

}  // namespace limen
