// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_copy.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "limen/base/error.h"
#include "limen/io/e57/e57_crc.h"

namespace limen {
namespace {

constexpr std::size_t kBlobHeaderBytes = 16;

/// Copies sections of one file to another; each gives its new physical offset.
class SectionCopy {
 public:
  SectionCopy(const E57Pages& from, E57PageWriter& to, const std::function<void()>& forget, Monitor& monitor)
      : from_(from), to_(to), forget_(forget), monitor_(monitor) {}

  std::uint64_t blob(std::uint64_t physical) {
    auto [at, end] = section_at(physical, kBlobHeaderBytes, 0);
    const std::uint64_t offset = to_.physical();
    constexpr std::uint64_t kAtOnce = std::uint64_t{1} << 20U;
    while (at < end) {
      const std::uint64_t step = std::min(kAtOnce, end - at);
      append(bytes(at, step));
      at += step;
    }
    to_.fill_word();
    return offset;
  }

  /// Packets follow one another; an index, whose offsets would be wrong, becomes an empty one.
  std::uint64_t packed(std::uint64_t physical, std::uint64_t records) {
    if (records == 0) return append_header(0);
    const auto [begin, end] = section_at(physical, kE57SectionHeaderBytes, 1);
    std::uint64_t at = from_.logical_of(number_at<std::uint64_t>(begin + 16), "the first packet");
    if (at < begin + kE57SectionHeaderBytes || at > end)
      fail("the first packet lies outside its section", begin);
    const std::uint64_t offset = append_header(end - at);
    while (at < end) {
      const std::uint64_t length = end - at < 4 ? 0 : std::uint64_t{number_at<std::uint16_t>(at + 2)} + 1;
      if (length < 4 || length > end - at)
        fail(fmt::format("a packet would have {} bytes, which is impossible", length), at);
      std::string packet = bytes(at, length);
      if (packet[0] == 0) packet = std::string{2, 0} + packet.substr(2, 2) + std::string(length - 4, '\0');
      append(packet);
      at += length;
    }
    to_.fill_word();
    return offset;
  }

 private:
  void append(const std::string& piece) {
    constexpr std::uint64_t kRemembered = std::uint64_t{16} << 20U;
    to_.append(piece);
    monitor_.throw_if_cancelled();
    if ((kept_ += piece.size()) < kRemembered) return;
    kept_ = 0;
    if (forget_) forget_();
  }
  [[noreturn]] void fail(const std::string& what, std::uint64_t logical) const {
    throw Error(what, fmt::format("{}, byte {}", from_.name(), from_.physical_of(logical)), kE57CopyAgain);
  }

  [[nodiscard]] std::string bytes(std::uint64_t logical, std::uint64_t count) const {
    from_.check(from_.page_of(logical), from_.page_of(logical + count - 1) + 1);
    std::string all(count, '\0');
    from_.copy(logical, count, all.data());
    return all;
  }
  template <typename Value>
  [[nodiscard]] Value number_at(std::uint64_t logical) const {
    Value value{};
    std::memcpy(&value, bytes(logical, sizeof value).data(), sizeof value);
    return value;
  }

  /// Where a section begins and ends.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> section_at(std::uint64_t physical, std::size_t header,
                                                                   char kind) const {
    const std::uint64_t begin = from_.logical_of(physical, "a section of the file");
    const std::uint64_t room = from_.logical_size() - begin;
    if (room < header || bytes(begin, 1)[0] != kind) fail("there is no section where one should be", begin);
    const auto length = number_at<std::uint64_t>(begin + 8);
    if (length < header || length > room)
      fail(fmt::format("a section would have {} bytes, which do not fit into the file", length), begin);
    return {begin, begin + length};
  }

  /// The head of a section of packets, which follow at once.
  std::uint64_t append_header(std::uint64_t packet_bytes) {
    const std::uint64_t offset = to_.physical();
    to_.append(e57_section_header(kE57SectionHeaderBytes + packet_bytes,
                                  to_.physical_of(to_.logical() + kE57SectionHeaderBytes)));
    return offset;
  }

  const E57Pages& from_;
  E57PageWriter& to_;
  const std::function<void()>& forget_;
  Monitor& monitor_;
  std::uint64_t kept_ = 0;  ///< bytes that were read since forget_ was called
};

std::vector<pugi::xml_node> elements_of(const pugi::xml_node& parent) {
  std::vector<pugi::xml_node> elements;
  for (const pugi::xml_node& child : parent.children()) {
    if (child.type() == pugi::node_element) elements.push_back(child);
  }
  return elements;
}

void set_pose(pugi::xml_node element, const Rigid3& pose) {
  element.remove_child("pose");
  const std::string xml = e57_pose_xml(pose);
  element.append_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
}

}  // namespace

E57Original::E57Original(std::string_view bytes, const std::string& name, std::function<void()> forget)
    : pages_(bytes, name), forget_(std::move(forget)), tree_(std::make_unique<pugi::xml_document>()) {
  const std::string xml = e57_xml(pages_);
  document_ = parse_e57_document(xml, name);  // throws where the next would fail
  tree_->load_buffer(xml.data(), xml.size(), pugi::parse_default | pugi::parse_ws_pcdata_single,
                     pugi::encoding_utf8);
  const pugi::xml_node root = tree_->child("e57Root");
  scans_ = elements_of(root.child("data3D"));
  images_ = elements_of(root.child("images2D"));
  for (const pugi::xml_attribute& attribute : root.attributes()) {
    constexpr std::string_view kPrefix = "xmlns:";
    const std::string_view key = attribute.name();
    if (key.substr(0, kPrefix.size()) == kPrefix)
      spaces_.emplace_back(key.substr(kPrefix.size()), attribute.value());
  }
  for (std::size_t k = 0; k < images_.size(); ++k) owners_.push_back(owner_of(k));
}

E57Original::~E57Original() = default;

std::size_t E57Original::owner_of(std::size_t image) const {
  const std::string_view guid = images_[image].child("associatedData3DGuid").text().get();
  const bool placed = document_.images[image].pose || document_.images[image].projected;
  const Vector3d place = document_.images[image].pose.value_or(Rigid3{}).translation;
  std::size_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < scans_.size(); ++k) {
    if (document_.scans[k].points == 0) continue;
    if (!guid.empty() && guid == scans_[k].child("guid").text().get()) return k;
    const double away_m =
        placed ? (document_.scans[k].pose.value_or(Rigid3{}).translation - place).norm() : 0.0;
    if (away_m >= least_m) continue;
    least_m = away_m;
    nearest = k;
  }
  return nearest;
}

std::vector<E57Picture> E57Original::pictures() const {
  std::vector<E57Picture> pictures;
  if (scans_.empty()) return pictures;
  for (std::size_t k = 0; k < images_.size(); ++k) {
    const std::size_t scan = owners_[k];
    const Rigid3 of_scan = document_.scans[scan].pose.value_or(Rigid3{});
    for (const auto& [element, type] : {std::pair{"jpegImage", "image/jpeg"}, {"pngImage", "image/png"}}) {
      const pugi::xml_node blob = images_[k].find_node(
          [name = std::string_view(element)](const pugi::xml_node& node) { return node.name() == name; });
      if (!blob) continue;
      pictures.push_back({scan, document_.images[k].pose.value_or(of_scan), type,
                          blob.attribute("fileOffset").as_ullong(), blob.attribute("length").as_ullong()});
      break;
    }
  }
  return pictures;
}

std::vector<std::uint8_t> E57Original::bytes_of(const E57Picture& picture) const {
  const std::uint64_t at = pages_.logical_of(picture.section, "an image") + kBlobHeaderBytes;
  const std::uint64_t end = pages_.logical_size();
  if (at > end || picture.bytes > end - at)
    throw Error(fmt::format("an image of {} bytes ends behind the file", picture.bytes), pages_.name(),
                "get the whole file, or export it again");
  std::vector<std::uint8_t> bytes(picture.bytes);
  if (bytes.empty()) return bytes;
  pages_.check(pages_.page_of(at), pages_.page_of(at + bytes.size() - 1) + 1);
  pages_.copy(at, bytes.size(), reinterpret_cast<char*>(bytes.data()));
  return bytes;
}

std::string E57Original::copied(const pugi::xml_node& element, const Rigid3* pose, E57PageWriter& file,
                                Monitor& monitor) const {
  pugi::xml_document copy;
  pugi::xml_node mine = copy.append_copy(element);
  if (pose != nullptr) set_pose(mine, *pose);
  SectionCopy sections(pages_, file, forget_, monitor);
  const auto nodes = copy.select_nodes("//*[@fileOffset]");
  for (const pugi::xpath_node& found : nodes) {
    const pugi::xml_node node = found.node();
    pugi::xml_attribute offset = node.attribute("fileOffset");
    const std::uint64_t from = offset.as_ullong();
    const bool packed = node.attribute("type").value() == std::string_view("CompressedVector");
    offset.set_value(packed ? sections.packed(from, node.attribute("recordCount").as_ullong())
                            : sections.blob(from));
  }
  std::ostringstream text;
  mine.print(text, "", pugi::format_raw, pugi::encoding_utf8);
  return text.str() + "\n";
}

E57Entry E57Original::copy(std::size_t scan, const Rigid3& target_from_source, E57PageWriter& file,
                           Monitor& monitor) const {
  E57Entry entry;
  const Rigid3 pose = target_from_source * document_.scans[scan].pose.value_or(Rigid3{});
  entry.scan = copied(scans_[scan], &pose, file, monitor);
  for (std::size_t k = 0; k < images_.size(); ++k) {
    if (owners_[k] != scan) continue;
    const E57Image& image = document_.images[k];
    const Rigid3 place = target_from_source * image.pose.value_or(Rigid3{});
    entry.images += copied(images_[k], image.pose || image.projected ? &place : nullptr, file, monitor);
  }
  entry.spaces = spaces_;
  if (!document_.coordinates.empty()) entry.georeference = {document_.coordinates};
  entry.digest = crc32c(entry.scan + entry.images);
  return entry;
}

}  // namespace limen
