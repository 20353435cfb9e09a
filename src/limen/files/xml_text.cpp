// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/xml_text.h"

#include <sstream>

namespace limen {

pugi::xml_document begun_xml() {
  pugi::xml_document document;
  pugi::xml_node head = document.append_child(pugi::node_declaration);
  head.append_attribute("version") = "1.0";
  head.append_attribute("encoding") = "UTF-8";
  return document;
}

std::string xml_text(const pugi::xml_document& document) {
  std::ostringstream stream;
  document.save(stream, "  ", pugi::format_indent, pugi::encoding_utf8);
  return stream.str();
}

void add_text(pugi::xml_node node, const char* name, const std::string& text) {
  std::string good;
  for (const char c : text) good += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
  node.append_child(name).append_child(pugi::node_pcdata).set_value(good.c_str());
}

}  // namespace limen
