// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_poses.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/io/e57/e57_description.h"
#include "limen/io/e57/e57_document.h"
#include "limen/io/e57/e57_pages.h"

namespace limen {
namespace {

/// A stretch of the description and what takes its place.
struct Edit {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string text;
};

/// The end of the tag, comment or text section that begins at `at` with '<', one past it.
std::size_t end_of_tag(std::string_view xml, std::size_t at) {
  const auto past = [&](std::string_view mark) {
    const std::size_t found = xml.find(mark, at);
    return found == std::string_view::npos ? xml.size() : found + mark.size();
  };
  if (xml.substr(at, 4) == "<!--") return past("-->");
  if (xml.substr(at, 9) == "<![CDATA[") return past("]]>");
  if (xml.substr(at, 2) == "<?") return past("?>");
  char quote = 0;
  for (std::size_t i = at; i < xml.size(); ++i) {
    if (quote != 0) {
      if (xml[i] == quote) quote = 0;
    } else if (xml[i] == '"' || xml[i] == '\'') {
      quote = xml[i];
    } else if (xml[i] == '>') {
      return i + 1;
    }
  }
  return xml.size();
}

/// The end of the element whose start tag begins at `at`, one past it.
std::size_t end_of_element(std::string_view xml, std::size_t at) {
  int depth = 0;
  while (at < xml.size()) {
    const std::size_t end = end_of_tag(xml, at);
    const bool section = xml[at + 1] == '!' || xml[at + 1] == '?';
    if (!section && xml[at + 1] == '/') --depth;
    if (!section && xml[at + 1] != '/' && xml[end - 2] != '/') ++depth;
    if (depth == 0 && !section) return end;
    at = std::min(xml.find('<', end), xml.size());
  }
  return xml.size();
}

/// Where the element's start tag begins in the description.
std::size_t begin_of(const pugi::xml_node& element, std::string_view xml, const std::string& name) {
  const std::ptrdiff_t offset = element.offset_debug();
  const std::string_view tag = element.name();
  const bool found = offset > 0 && xml.substr(static_cast<std::size_t>(offset), tag.size()) == tag &&
                     xml[static_cast<std::size_t>(offset) - 1] == '<';
  if (!found) throw Error("the description (XML) cannot be edited in place", name, "export the file again");
  return static_cast<std::size_t>(offset) - 1;
}

pugi::xml_node first_element(const pugi::xml_node& parent) {
  for (const pugi::xml_node& child : parent.children()) {
    if (child.type() == pugi::node_element) return child;
  }
  return {};
}

/// The edit that gives an element (scan or image) its pose.
Edit pose_edit(const pugi::xml_node& element, const Rigid3& pose, std::string_view xml,
               const std::string& name) {
  if (const pugi::xml_node old = element.child("pose")) {
    const std::size_t begin = begin_of(old, xml, name);
    return {begin, end_of_element(xml, begin), e57_pose_xml(pose)};
  }
  const std::size_t begin = begin_of(first_element(element), xml, name);
  return {begin, begin, e57_pose_xml(pose)};
}

/// Edits of all poses, in the order of the file.
std::vector<Edit> pose_edits(std::string_view xml, const E57Document& document, const Rigid3& motion,
                             const std::string& name) {
  pugi::xml_document tree;
  // Parsed before by parse_e57_document: this cannot fail.
  tree.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
  const pugi::xml_node root = tree.child("e57Root");
  std::vector<Edit> edits;
  std::size_t index = 0;
  for (const pugi::xml_node& scan : root.child("data3D").children()) {
    if (scan.type() != pugi::node_element) continue;
    const Rigid3 old = document.scans[index++].pose.value_or(Rigid3{});
    edits.push_back(pose_edit(scan, motion * old, xml, name));
  }
  index = 0;
  for (const pugi::xml_node& image : root.child("images2D").children()) {
    if (image.type() != pugi::node_element) continue;
    const E57Image& known = document.images[index++];
    if (!known.pose && !known.projected) continue;
    edits.push_back(pose_edit(image, motion * known.pose.value_or(Rigid3{}), xml, name));
  }
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
  return edits;
}

std::string edited(std::string_view xml, const std::vector<Edit>& edits) {
  std::string result;
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    result += xml.substr(at, edit.begin - at);
    result += edit.text;
    at = edit.end;
  }
  result += xml.substr(at);
  return result;
}

/// Pages [first, last) of the source and the payloads that take their place.
struct Replacement {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::string payload;
  E57Head head;
};

std::string payload_of(const E57Pages& pages, std::uint64_t begin, std::uint64_t end) {
  std::string bytes(end - begin, '\0');
  pages.copy(begin, bytes.size(), bytes.data());
  return bytes;
}

/// True where nothing but padding follows the description.
bool stands_last(const E57Pages& pages, std::uint64_t end) {
  if (pages.logical_size() - end >= pages.payload()) return false;
  const std::string rest = payload_of(pages, end, pages.logical_size());
  return std::all_of(rest.begin(), rest.end(), [](char c) { return c == '\0'; });
}

/// How the new description comes into the file: where the old one was, if that was last or the new one is no
/// longer; else behind all.
Replacement replacement_of(const E57Pages& pages, std::string xml) {
  const std::uint64_t payload = pages.payload();
  Replacement result;
  result.head = pages.head();
  const std::uint64_t begin = pages.logical_of(result.head.xml_offset, "the description (XML)");
  const std::uint64_t end = begin + result.head.xml_bytes;
  const std::uint64_t first_byte = pages.page_of(begin) * payload;
  result.first = pages.page_of(begin);
  if (stands_last(pages, end)) {
    result.last = pages.page_count();
    result.head.xml_bytes = xml.size();
    result.payload = payload_of(pages, first_byte, begin) + xml;
  } else if (xml.size() <= result.head.xml_bytes) {
    result.last = pages.page_of(end - 1) + 1;
    xml.resize(result.head.xml_bytes, ' ');
    result.payload =
        payload_of(pages, first_byte, begin) + xml + payload_of(pages, end, result.last * payload);
  } else {
    result.first = result.last = pages.page_count();
    result.head.xml_offset = pages.physical_of(pages.logical_size());
    result.head.xml_bytes = xml.size();
    result.payload = std::move(xml);
  }
  result.payload.resize((result.payload.size() + payload - 1) / payload * payload, '\0');
  const std::uint64_t count =
      pages.page_count() - (result.last - result.first) + result.payload.size() / payload;
  result.head.file_bytes = count * result.head.page_bytes;
  return result;
}

void write_page(AtomicFile& file, std::string_view payload) {
  file.write(payload);
  file.write(e57_check_sum(payload));
}

/// Copies pages as they are, their check sums verified.
void copy_pages(AtomicFile& file, const E57Pages& pages, std::uint64_t begin, std::uint64_t end,
                Monitor& monitor) {
  constexpr std::uint64_t kAtOnce = 4096;
  for (; begin < end; begin += std::min(kAtOnce, end - begin)) {
    const std::uint64_t stop = begin + std::min(kAtOnce, end - begin);
    pages.check(begin, stop);
    file.write(pages.raw(begin, stop));
    monitor.throw_if_cancelled();
    monitor.advance(static_cast<double>(stop * pages.head().page_bytes),
                    static_cast<double>(pages.page_count() * pages.head().page_bytes));
  }
}

void write_replaced(const E57Pages& pages, Replacement changed, const std::filesystem::path& output,
                    Monitor& monitor) {
  const std::uint64_t payload = pages.payload();
  const std::string head = e57_head_bytes(changed.head);
  AtomicFile file(output);
  if (changed.first == 0) {
    changed.payload.replace(0, head.size(), head);
  } else {
    pages.check(0, 1);
    std::string first = payload_of(pages, 0, payload);
    write_page(file, first.replace(0, head.size(), head));
    copy_pages(file, pages, 1, changed.first, monitor);
  }
  for (std::size_t at = 0; at < changed.payload.size(); at += payload)
    write_page(file, std::string_view(changed.payload).substr(at, payload));
  copy_pages(file, pages, changed.last, pages.page_count(), monitor);
  file.commit();
}

}  // namespace

std::string with_coordinate_system(const std::string& xml, const std::string& wkt) {
  std::string quoted = as_utf8(wkt);
  // The one thing that may not stand in a section of characters is its end.
  for (std::size_t at = quoted.find("]]>"); at != std::string::npos; at = quoted.find("]]>", at + 3))
    quoted.replace(at, 3, "]] >");
  const std::string element =
      "<coordinateMetadata type=\"String\"><![CDATA[" + quoted + "]]></coordinateMetadata>";
  const std::string begin = "<coordinateMetadata";
  const std::string end = "</coordinateMetadata>";
  const std::size_t at = xml.find(begin);
  if (at != std::string::npos) {
    const std::size_t head = xml.find('>', at);
    const bool closed = head != std::string::npos && xml[head - 1] == '/';
    const std::size_t behind = closed ? head + 1 : xml.find(end, at) + end.size();
    return xml.substr(0, at) + element + xml.substr(behind);
  }
  const std::size_t last = xml.rfind("</e57Root>");
  if (last == std::string::npos) return xml;
  return xml.substr(0, last) + element + xml.substr(last);
}

MovedE57 replace_e57_poses(std::string_view bytes, const std::string& name, const Rigid3& target_from_source,
                           const std::filesystem::path& output, Monitor& monitor, const std::string& wkt) {
  monitor.set_unit(WorkUnit::bytes);
  const E57Pages pages(bytes, name);
  const std::string xml = e57_xml(pages);
  const E57Document document = parse_e57_document(xml, name);
  MovedE57 result;
  result.scans = document.scans.size();
  result.images = document.images.size();
  for (const E57Scan& scan : document.scans) result.points += scan.points;
  if (document.scans.empty()) throw Error("the file holds no scans", name, "name a file with scans");
  if (!document.coordinates.empty() && wkt.empty()) {
    result.notes.emplace_back(
        "the file states a coordinate system, which is kept: check that it is the target's");
  }
  if (pages.surplus() > 0) {
    result.notes.push_back(
        fmt::format("{} bytes after the stated end of the file are left out", pages.surplus()));
  }
  std::string moved = edited(xml, pose_edits(xml, document, target_from_source, name));
  if (!wkt.empty()) moved = with_coordinate_system(moved, wkt);
  const E57Document check = parse_e57_document(moved, name);
  if (check.scans.size() != result.scans || check.images.size() != result.images) {
    throw Error("the description (XML) did not survive its editing", name, "", Fault::internal);
  }
  write_replaced(pages, replacement_of(pages, std::move(moved)), output, monitor);
  return result;
}

}  // namespace limen
