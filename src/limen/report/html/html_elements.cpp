// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_elements.h"

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/report/html/html_bytes.h"

namespace limen {
namespace {

std::string script_element(const char* type, const std::string& id, const std::string& content) {
  return fmt::format("<script type=\"{}\" id=\"{}\">{}</script>\n", type, id, content);
}

/// The page shows its texts, which hold names of files and elements.
void make_printable(Json& json) {
  if (json.is_string()) json = printable_lines(json.get_ref<const std::string&>());
  if (!json.is_structured()) return;
  for (Json& part : json) make_printable(part);
}

}  // namespace

std::string blob_element(const std::string& id, const std::vector<std::uint8_t>& bytes) {
  if (bytes.empty()) return {};
  return script_element("text/plain", id, base64(bytes));
}

std::string json_element(Json json, const std::string& id) {
  make_printable(json);
  std::string safe;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return script_element("application/json", id, safe);
}

std::string scrolled_table(const std::string& label, const std::vector<std::string>& head,
                           const std::string& rows) {
  std::string cells;
  for (const std::string& cell : head) {
    const bool number = cell.starts_with('#');
    cells += fmt::format("<th scope=\"col\"{}>{}</th>", number ? " class=\"n\"" : "",
                         number ? cell.substr(1) : cell);
  }
  return fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"{}\"><table><thead><tr>{}</tr></thead>"
      "<tbody>\n{}</tbody></table></div>\n",
      label, cells, rows);
}

std::string filled_in(std::string_view pattern, const PageParts& parts) {
  std::string text;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = pattern.find("{{", at);
    const std::size_t close = open == std::string_view::npos ? open : pattern.find("}}", open);
    if (close == std::string_view::npos) break;
    text += pattern.substr(at, open - at);
    const auto part = parts.find(std::string(pattern.substr(open + 2, close - open - 2)));
    if (part != parts.end()) text += part->second;
    at = close + 2;
  }
  return text.append(pattern.substr(at));
}

}  // namespace limen
