// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/version.h"
#include "limen/project/state/scan_names.h"
#include "limen/report/deviation/building_report.h"
#include "limen/report/deviation/deviation_report.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/report_page.h"

namespace limen {
namespace {

constexpr std::size_t kBuildingRows = 2000;  // of a table; the CSV has all
constexpr double kPlanWidth = 1100.0;        // units of the drawing
constexpr double kPlanHeight = 800.0;        // at most
constexpr double kPlanUpright = 0.3;         // cosine to the vertical of normals that a plan shows

/// The class of an element in colours and words.
const char* class_of(const ElementDeviation& it, double moved_m) {
  return has_moved(it, moved_m) ? "moved" : to_string(it.presence);
}

/// The models from above.
class BuildingPlan {
 public:
  explicit BuildingPlan(const BuildingReport& report) : report_(report) {
    for (const BimFace& face : report.model.faces) {
      for (const Vector2d& p : face.outline.outer) take(face.frame.to_space(p).head<2>());
    }
    const Vector2d size = (high_ - low_).cwiseMax(Vector2d::Constant(0.1));
    scale_ = std::min(kPlanWidth / size.x(), kPlanHeight / size.y());
  }

  [[nodiscard]] std::string svg() const {
    const Vector2d size = scale_ * (high_ - low_);
    std::string text = fmt::format(
        "<svg class=\"plan\" role=\"img\" aria-label=\"The elements from above, coloured by what was found\" "
        "viewBox=\"-20 -20 {:.0f} {:.0f}\">\n",
        size.x() + 40.0, size.y() + 40.0);
    // What is wrong is drawn last, over the rest.
    for (const char* wanted : {"not_judged", "found", "moved", "not_found"}) text += faces_of_class(wanted);
    for (const UnmodelledObject& piece : report_.deviation.unmodelled) text += box(piece);
    for (const BuildingScan& scan : report_.scans) text += scanner(scan);
    return text + "</svg>\n";
  }

 private:
  void take(const Vector2d& p) {
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }

  [[nodiscard]] Vector2d drawn(const Vector2d& p) const {
    return {scale_ * (p.x() - low_.x()), scale_ * (high_.y() - p.y())};
  }

  [[nodiscard]] std::string faces_of_class(const std::string& wanted) const {
    std::string text;
    for (const BimFace& face : report_.model.faces) {
      const auto k = static_cast<std::size_t>(face.element);
      if (std::abs(face.plane.normal.z()) > kPlanUpright) continue;
      if (class_of(report_.deviation.elements[k], report_.issues.moved_m) != wanted) continue;
      text += line_of(face, wanted);
    }
    return text;
  }

  /// An upright face from above is a line.
  [[nodiscard]] std::string line_of(const BimFace& face, const std::string& name) const {
    double low = 1e300;
    double high = -1e300;
    Vector2d from = Vector2d::Zero();
    Vector2d to = Vector2d::Zero();
    const Vector2d along = Vector2d(-face.plane.normal.y(), face.plane.normal.x()).normalized();
    for (const Vector2d& p : face.outline.outer) {
      const Vector2d x = face.frame.to_space(p).head<2>();
      const double place = along.dot(x);
      if (place < low) {
        low = place;
        from = x;
      }
      if (place > high) {
        high = place;
        to = x;
      }
    }
    const Vector2d a = drawn(from);
    const Vector2d b = drawn(to);
    return fmt::format("<line class=\"face {}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                       name, a.x(), a.y(), b.x(), b.y());
  }

  [[nodiscard]] std::string box(const UnmodelledObject& piece) const {
    if (!piece.within_model) return {};
    const Vector2d corner = drawn({piece.low.x(), piece.high.y()});
    const Vector2d size = scale_ * (piece.high - piece.low).head<2>();
    return fmt::format("<rect class=\"box\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
                       corner.x(), corner.y(), size.x(), size.y());
  }

  /// Of a scan in its own coordinates: where their origin comes to lie, which is the scanner of most
  /// stations.
  [[nodiscard]] std::string scanner(const BuildingScan& scan) const {
    const Vector3d place = scan.model_from_scan.translation - report_.model.local_origin;
    if ((place.head<2>() - 0.5 * (low_ + high_)).norm() > (high_ - low_).norm()) return {};
    const Vector2d at = drawn(place.head<2>());
    return fmt::format("<circle class=\"seen\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n", at.x(), at.y());
  }

  const BuildingReport& report_;
  Vector2d low_ = Vector2d::Constant(1e300);
  Vector2d high_ = Vector2d::Constant(-1e300);
  double scale_ = 1.0;
};

std::string element_row(const BuildingReport& report, std::size_t k) {
  const ElementDeviation& it = report.deviation.elements[k];
  const BimElement& element = report.model.elements[k];
  const char* name = class_of(it, report.issues.moved_m);
  std::string row = fmt::format(
      "<tr><td class=\"state {0}\">{0}</td><td translate=\"no\">{1}</td><td translate=\"no\">{2}</td><td "
      "translate=\"no\">{3}</td><td "
      "class=\"guid\" translate=\"no\">{4}</td><td "
      "class=\"n\">{5}</td>",
      name, escaped(element.name), escaped(element.type), escaped(element.storey), escaped(element.guid),
      report.deviation.seen_by[k]);
  if (it.points > 0 && it.presence == Presence::found) {
    const Vector3d shift = 1e3 * it.shift.shift_m;
    row += it.shift.held > 0
               ? fmt::format("<td class=\"n\">{:.1f}</td><td class=\"n\">{:.1f} {:.1f} {:.1f}</td>",
                             shift.norm(), shift.x() + 0.0, shift.y() + 0.0, shift.z() + 0.0)
               : std::string("<td></td><td></td>");
    row += fmt::format("<td class=\"n\">{:.1f}</td><td class=\"n\">{:.1f}</td><td>{}</td>", 1e3 * it.median_m,
                       1e3 * it.p95_m, it.loa > 0 ? fmt::format("LOA{}", it.loa) : "");
  } else {
    row += "<td></td><td></td><td></td><td></td><td></td>";
  }
  return row + fmt::format("<td class=\"n\">{:.1f}</td><td class=\"n\">{:.0f} %</td></tr>\n", it.passed_m2,
                           100.0 * it.covered_share);
}

std::string elements_table(const BuildingReport& report) {
  std::string rows;
  std::size_t shown = 0;
  std::size_t unjudged = 0;
  for (const std::size_t k : worst_first(report.deviation.elements)) {
    if (report.deviation.elements[k].presence == Presence::not_judged) {
      ++unjudged;
    } else if (shown++ < kBuildingRows) {
      rows += element_row(report, k);
    }
  }
  const std::string title = "Elements, the worst first";
  std::string text =
      "<h2>" + title + "</h2>\n" +
      scrolled_table(title,
                     {"state", "name", "type", "storey", "GUID", "#scans", "#off by, mm", "#x y z, mm",
                      "#median, mm", "#95 %, mm", "class", "#seen through, m²", "#covered"},
                     rows);
  if (shown > kBuildingRows)
    text += fmt::format("<p class=\"soft\">{} more are in deviation.csv.</p>\n", shown - kBuildingRows);
  return text +
         fmt::format(
             "<p class=\"soft\">{} elements could not be judged: hidden, out of reach, or panes that let "
             "light pass.</p>\n",
             unjudged);
}

std::string unmodelled_table(const BuildingReport& report) {
  std::string rows;
  std::size_t shown = 0;
  for (const UnmodelledObject& piece : report.deviation.unmodelled) {
    if (!piece.within_model || shown++ >= kBuildingRows) continue;
    const Vector3d size = piece.high - piece.low;
    const Vector3d middle = report.model.local_origin + piece.centre;
    rows += fmt::format(
        "<tr><td class=\"n\">{}</td><td class=\"n\">{:.2f} {:.2f} {:.2f}</td><td class=\"n\">{:.2f} {:.2f} "
        "{:.2f}</td></tr>\n",
        piece.points, size.x(), size.y(), size.z(), middle.x(), middle.y(), middle.z());
  }
  if (rows.empty()) return {};
  const std::string title = "Objects that are not in the model";
  return "<h2>" + title + "</h2>\n" + scrolled_table(title, {"#points", "#size, m", "#position, m"}, rows);
}

std::string name_of(const BuildingReport& report, const std::string& path, int index) {
  const auto same = [&](const auto& other) { return other.path == path; };
  const auto count = std::count_if(report.scans.begin(), report.scans.end(), same) +
                     std::count_if(report.left_out.begin(), report.left_out.end(), same);
  return scan_name(NumberedScan{path, index, count > 1});
}

std::string shares_table(const BuildingReport& report) {
  std::string rows;
  for (std::size_t k = 0; k < report.scans.size(); ++k) {
    const BuildingScan& scan = report.scans[k];
    const ScanShare& share = report.deviation.scans[k];
    const Vector3d common = 1e3 * share.common.shift_m;
    rows += fmt::format(
        "<tr><td class=\"path\" translate=\"no\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{:.0f} %</td><td "
        "class=\"n\">{:.1f}</td><td class=\"n\">{:.1f} {:.1f} {:.1f}</td><td>{}{}</td></tr>\n",
        escaped(name_of(report, scan.path, scan.index)), share.points,
        100.0 * static_cast<double>(share.matched) /
            static_cast<double>(std::max<std::size_t>(1, share.points)),
        1e3 * scan.pose_sigma_m, common.x() + 0.0, common.y() + 0.0, common.z() + 0.0,
        scan.bent ? "Drift corrected.<br>" : "",
        share.oriented ? ""
                       : "Its scanner position is unknown, so it cannot show that elements are missing.");
  }
  for (const BuildingLeftOut& it : report.left_out)
    rows += fmt::format(
        "<tr><td class=\"path\" translate=\"no\">{}</td><td></td><td></td><td></td><td></td><td>left out: "
        "{}</td></tr>\n",
        escaped(name_of(report, it.path, it.index)), escaped(it.reason));
  return "<h2>Scans</h2>\n" +
         scrolled_table("Scans",
                        {"file", "#points", "#on faces", "#sigma of the pose, mm", "#common shift, mm", ""},
                        rows);
}

std::string models_list(const BuildingReport& report) {
  std::string text = "<h2>Models</h2>\n<ul>\n";
  for (const BuildingModel& model : report.models) {
    const char* words = model.place == "project"          ? "placed by the project"
                        : model.place == "with the first" ? "assumed to be in one frame with the first"
                                                          : "assumed to be in the project's frame";
    text += fmt::format("<li><span translate=\"no\">{}</span>: <span>{} elements, {}</span></li>\n",
                        escaped(model.path), model.elements, words);
  }
  return text + "</ul>\n";
}

}  // namespace

std::string building_page(const BuildingReport& report, const ReportCover& cover) {
  const BuildingDeviation& deviation = report.deviation;
  std::size_t counts[3] = {0, 0, 0};
  std::size_t moved = 0;
  for (const ElementDeviation& it : deviation.elements) {
    ++counts[static_cast<std::size_t>(it.presence)];
    moved += has_moved(it, report.issues.moved_m) ? 1 : 0;
  }
  std::string text = filled_in(
      page_head(), {{"title", escaped(cover.title.empty() ? in_language("limen: deviation", cover.language)
                                                          : cover.title)},
                    {"style", std::string(table_style())},
                    {"version", kVersion}});
  text += fmt::format(
      "<body><main>\n{}<h1>{} missing, {} moved by more than {:.0f} mm, of {} elements that "
      "were "
      "judged</h1>\n<p class=\"soft\">{} points of {} scans against {} elements; {} of the points lie on "
      "faces of the "
      "model, {} far from all of them. Coordinates are those of {}. limen {}.</p>\n",
      cover_facts(cover), counts[1], moved, 1e3 * report.issues.moved_m, counts[0] + counts[1],
      deviation.points, report.scans.size(), deviation.elements.size(), deviation.matched, deviation.far,
      escaped(report.models.front().path), kVersion);
  text += "<h2>Plan</h2>\n" + BuildingPlan(report).svg() +
          "<p class=\"soft\">From above: <span class=\"state found\">found</span>, <span class=\"state "
          "moved\">moved</span>, <span class=\"state not_found\">not found</span>, <span class=\"state "
          "not_judged\">not judged</span>; filled boxes: objects that are not in the model; dots: origins of "
          "scans.</p>\n";
  text += elements_table(report) + unmodelled_table(report) + shares_table(report) + models_list(report);
  return page_in_language(text + signature_html(cover) + "</main></body></html>\n", cover.language);
}

}  // namespace limen
