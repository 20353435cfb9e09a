// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/language.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/args.h>
#include <fmt/format.h>

#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/report_page.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

using TextTable = std::vector<std::pair<std::string, std::string>>;

struct Texts {
  std::map<std::string, std::string, std::less<>> whole;
  TextTable patterns;  ///< those with values, the most words first
};

TextTable rows_of(std::string_view table) {
  TextTable rows;
  while (!table.empty()) {
    const std::string_view line = table.substr(0, table.find('\n'));
    const std::size_t tab = line.find('\t');
    if (tab != std::string_view::npos) rows.emplace_back(line.substr(0, tab), line.substr(tab + 1));
    table.remove_prefix(std::min(table.size(), line.size() + 1));
  }
  return rows;
}

Texts texts_from(std::string_view table) {
  Texts texts;
  for (const auto& [key, other] : rows_of(table)) {
    const std::string english = square_metres(key);
    if (english.find("{}") == std::string::npos)
      texts.whole.emplace(english, other);
    else
      texts.patterns.emplace_back(english, other);
  }
  std::stable_sort(texts.patterns.begin(), texts.patterns.end(),
                   [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
  return texts;
}

std::string_view table_of(Language language) {
  return language == Language::french ? french_texts() : german_texts();
}

const Texts& texts_of(Language language) {
  static const std::array<Texts, 2> kTexts = {texts_from(french_texts()), texts_from(german_texts())};
  return kTexts[language == Language::french ? 0 : 1];
}

bool has_letters(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return (c | 32) >= 'a' && (c | 32) <= 'z'; });
}

/// Words that are a number, a unit or a sign.
bool is_figure(std::string_view text) {
  static const std::set<std::string, std::less<>> kUnits = {"mm", "cm", "m", "m²", "m2", "s", "x", "y", "z"};
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    if (has_letters(word) && kUnits.count(word) == 0) return false;
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return true;
}

/// 1.5 as 1,5 and 1.5, 2.5 as 1,5; 2,5; what has two points is no number.
std::string with_comma(std::string text) {
  const auto digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '.' || at == 0 || !digit(at - 1) || !digit(at + 1)) continue;
    std::size_t end = at + 1;
    while (digit(end)) ++end;
    if (end == text.size() || text[end] != '.') text[at] = ',';
    if (text.compare(end, 2, ", ") == 0 && (digit(end + 2) || text.compare(end + 2, 1, "-") == 0))
      text[end] = ';';
    at = end;
  }
  return text;
}

/// The values at the {} of a pattern.
std::optional<std::vector<std::string>> values_in(std::string_view text, std::string_view pattern) {
  std::vector<std::string> values;
  std::size_t open = pattern.find("{}");
  if (text.substr(0, open) != pattern.substr(0, open)) return std::nullopt;
  text.remove_prefix(open);
  while (open != std::string_view::npos) {
    pattern.remove_prefix(open + 2);
    open = pattern.find("{}");
    const std::string_view between = pattern.substr(0, open);
    const std::size_t end = between.empty()                  ? text.size()
                            : open == std::string_view::npos ? text.rfind(between)
                                                             : text.find(between);
    if (end == std::string_view::npos || end == 0) return std::nullopt;
    values.emplace_back(text.substr(0, end));
    text.remove_prefix(end + between.size());
  }
  if (!text.empty()) return std::nullopt;
  return values;
}

/// The first letter small, of English.
std::string with_small(std::string text) {
  if (text[0] >= 'A' && text[0] <= 'Z') text[0] = static_cast<char>(text[0] + 32);
  return text;
}

/// The first letter large, of any of the languages: of UTF-8 those that begin with c3.
std::string with_capital(std::string text) {
  const std::size_t at = text.starts_with('\xc3') ? 1 : 0;
  const auto code = static_cast<unsigned char>(text[at]);
  if (at == 1 ? code >= 0xa0 && code < 0xbf : code >= 'a' && code <= 'z')
    text[at] = static_cast<char>(code - 32);
  return text;
}

class Translator {
 public:
  Translator(Language language, std::set<std::string>* missing)
      : texts_(texts_of(language)), missing_(missing) {}

  [[nodiscard]] std::string text(const std::string& english, bool value = false) const {
    if (is_figure(english)) return with_comma(english);
    const std::string plain = square_metres(english);
    // A reason that was made a sentence stands in the table without the capital and the full stop.
    const bool stop = plain.ends_with('.');
    const bool words = plain.find(' ') != std::string::npos;
    const std::string reason = words ? with_small(plain.substr(0, plain.size() - (stop ? 1 : 0))) : plain;
    const auto sentence = [&](const std::string& other) { return with_capital(other) + (stop ? "." : ""); };
    if (const auto it = texts_.whole.find(plain); it != texts_.whole.end()) return it->second;
    if (const auto it = texts_.whole.find(reason); it != texts_.whole.end()) return sentence(it->second);
    for (const auto& [pattern, other] : texts_.patterns) {
      if (const auto values = values_in(plain, pattern)) return filled(other, *values);
      if (const auto values = values_in(reason, pattern)) return sentence(filled(other, *values));
    }
    // Values may be names, which are one word in tests.
    if (missing_ && (!value || english.find(' ') != std::string::npos)) missing_->insert(english);
    return english;
  }

  /// Between two tags, with the space around it.
  [[nodiscard]] std::string node(std::string_view html) const {
    constexpr const char* kSpace = " \n\r\t";
    const std::size_t from = html.find_first_not_of(kSpace);
    if (from == std::string_view::npos || !has_letters(html)) return with_comma(std::string(html));
    const std::size_t to = html.find_last_not_of(kSpace) + 1;
    const std::string plain = unescaped(html.substr(from, to - from));
    return std::string(html.substr(0, from)) + escaped(text(plain)) + std::string(html.substr(to));
  }

  /// The labels of a tag.
  [[nodiscard]] std::string tag(std::string html) const {
    constexpr std::string_view kLabel = " aria-label=\"";
    const std::size_t label = html.find(kLabel);
    if (label == std::string::npos) return html;
    const std::size_t from = label + kLabel.size();
    const std::size_t count = html.find('"', from) - from;
    return html.replace(from, count, node(html.substr(from, count)));
  }

 private:
  [[nodiscard]] std::string filled(const std::string& pattern, const std::vector<std::string>& values) const {
    fmt::dynamic_format_arg_store<fmt::format_context> arguments;
    for (const std::string& one : values) arguments.push_back(text(one, true));
    return fmt::vformat(pattern, arguments);
  }

  static std::string unescaped(std::string_view html) {
    static const std::array<std::pair<std::string, std::string>, 5> kSigns = {
        {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}}};
    std::string text(html);
    for (const auto& [sign, character] : kSigns) {
      for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at + 1))
        text.replace(at, sign.size(), character);
    }
    return text;
  }

  const Texts& texts_;
  std::set<std::string>* missing_;
};

}  // namespace

const char* code_of(Language language) {
  constexpr std::array kCodes = {"en", "fr", "de"};
  return kCodes[static_cast<std::size_t>(language)];
}

std::string in_language(const std::string& text, Language language) {
  return language == Language::english ? text : Translator(language, nullptr).text(text);
}

std::string page_in_language(std::string_view html, Language language, std::set<std::string>* missing) {
  if (language == Language::english) return std::string(html);
  const Translator translator(language, missing);
  std::string page;
  bool kept = false;
  while (!html.empty()) {
    const std::size_t open = std::min(html.find('<'), html.size());
    const std::string_view text = html.substr(0, open);
    page += kept ? std::string(text) : translator.node(text);
    html.remove_prefix(open);
    if (html.empty()) break;
    const std::string_view tag = html.substr(0, html.find('>') + 1);
    kept = tag.find(" translate=\"no\"") != std::string_view::npos || tag.starts_with("<script") ||
           tag.starts_with("<style");
    page += tag == "<html lang=\"en\">" ? fmt::format("<html lang=\"{}\">", code_of(language))
                                        : translator.tag(std::string(tag));
    html.remove_prefix(tag.size());
    if (!tag.starts_with("<script")) continue;
    const std::size_t end = html.find("</script>");  // a script may compare with <
    page += html.substr(0, end);
    html.remove_prefix(end);
  }
  return page;
}

std::string texts_element(Language language) {
  if (language == Language::english) return {};
  Json texts = Json::object();
  for (const auto& [english, other] : rows_of(table_of(language))) texts[english] = other;
  return json_element(std::move(texts), "texts");
}

}  // namespace limen
