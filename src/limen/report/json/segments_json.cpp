// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/segments_json.h"

#include "limen/base/version.h"
#include "limen/report/json/json_values.h"

namespace limen {

std::string segments_json(const std::vector<Segment>& segments, const Vector3d& local_origin,
                          const InputSummary& input) {
  Json json;
  json["input"] = {{"path", input.path}, {"points", input.points}, {"centre_known", input.centre_known}};
  if (input.kind == "scan") json["input"]["scanner"] = json_of(input.place);
  json["segments"] = Json::array();
  for (const Segment& segment : segments) {
    Json ends;
    ends["a"] = json_of(Vector3d(local_origin + segment.a));
    ends["b"] = json_of(Vector3d(local_origin + segment.b));
    json["segments"].push_back(std::move(ends));
  }
  json["version"] = kVersion;
  return to_text(json);
}

}  // namespace limen
