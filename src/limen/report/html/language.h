// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace limen {

/// In which language a report is. Texts are written in English; page/fr.tsv and page/de.tsv have those of the
/// others, a line each: English, a tab, the other. {} is a place for a value, {0}, {1}, ... where they change
/// places.
enum class Language { english, french, german };
const char* code_of(Language language);

/// The text by the table of the language; its values too, and numbers with their decimal sign; a sentence
/// also as the reason it was made of, without capital and full stop. What the table does not have stays.
std::string in_language(const std::string& text, Language language);

/// The same of the texts and labels of HTML, but for what is directly in an element with translate="no".
/// `missing`: where texts go that the table does not have.
std::string page_in_language(std::string_view html, Language language,
                             std::set<std::string>* missing = nullptr);

/// The table for a page's script; nothing in English.
std::string texts_element(Language language);

}  // namespace limen
