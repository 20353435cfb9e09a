// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <pugixml.hpp>

namespace limen {

/// A document that has its declaration (version 1.0, UTF-8) and nothing else.
pugi::xml_document begun_xml();

/// The bytes of a document, indented.
std::string xml_text(const pugi::xml_document& document);

/// Adds an element that holds a text; control characters, which XML 1.0 cannot hold, become blanks.
void add_text(pugi::xml_node node, const char* name, const std::string& text);

}  // namespace limen
