// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/sheet/sheet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "limen/base/text.h"
#include "limen/files/table_cells.h"
#include "limen/files/xml_text.h"
#include "limen/files/zip.h"

namespace limen {
namespace {

constexpr const char* kMain = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
constexpr const char* kRelations = "http://schemas.openxmlformats.org/package/2006/relationships";
constexpr const char* kOffice = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
constexpr const char* kTypes = "http://schemas.openxmlformats.org/package/2006/content-types";
constexpr const char* kPart = "application/vnd.openxmlformats-officedocument.spreadsheetml.";
constexpr std::size_t kWideColumn = 60;  // characters
constexpr std::size_t kNarrowColumn = 8;

using Attributes = std::vector<std::pair<const char*, std::string>>;

pugi::xml_node add(pugi::xml_node parent, const char* name, const Attributes& attributes) {
  pugi::xml_node node = parent.append_child(name);
  for (const auto& [key, value] : attributes) node.append_attribute(key) = value.c_str();
  return node;
}

/// A, B, ..., Z, AA, ...
std::string column_name(std::size_t column) {
  std::string name;
  for (std::size_t k = column + 1; k > 0; k = (k - 1) / 26) name += static_cast<char>('A' + (k - 1) % 26);
  std::reverse(name.begin(), name.end());
  return name;
}

void add_cell(pugi::xml_node row, const std::string& at, const SheetCell& cell, bool head) {
  if (cell.text.empty()) return;
  pugi::xml_node node = add(row, "c", {{"r", at}});
  if (head) node.append_attribute("s") = 1;
  if (cell.number) {
    add_text(node, "v", cell.text);
    return;
  }
  node.append_attribute("t") = "inlineStr";
  add_text(node.append_child("is"), "t", cell.text);
}

void add_row(pugi::xml_node data, std::size_t number, const SheetRow& cells, bool head) {
  pugi::xml_node row = add(data, "row", {{"r", fmt::to_string(number)}});
  for (std::size_t c = 0; c < cells.size(); ++c)
    add_cell(row, column_name(c) + fmt::to_string(number), cells[c], head);
}

std::size_t width_of(const Sheet& sheet, std::size_t column) {
  std::size_t width = std::max(kNarrowColumn, sheet.columns[column].size() + 2);  // room for the filter
  for (const SheetRow& row : sheet.rows) width = std::max(width, row[column].text.size() + 1);
  return std::min(width, kWideColumn);
}

SheetRow head_of(const Sheet& sheet) {
  SheetRow head;
  for (const std::string& column : sheet.columns) head.push_back(text_cell(column));
  return head;
}

std::string sheet_text(const Sheet& sheet) {
  pugi::xml_document document = begun_xml();
  pugi::xml_node root = add(document, "worksheet", {{"xmlns", kMain}});
  pugi::xml_node view = add(root.append_child("sheetViews"), "sheetView", {{"workbookViewId", "0"}});
  add(view, "pane",
      {{"ySplit", "1"}, {"topLeftCell", "A2"}, {"activePane", "bottomLeft"}, {"state", "frozen"}});
  pugi::xml_node columns = root.append_child("cols");
  for (std::size_t c = 0; c < sheet.columns.size(); ++c) {
    const std::string number = fmt::to_string(c + 1);
    add(columns, "col",
        {{"min", number},
         {"max", number},
         {"width", fmt::to_string(width_of(sheet, c))},
         {"customWidth", "1"}});
  }
  pugi::xml_node data = root.append_child("sheetData");
  add_row(data, 1, head_of(sheet), true);
  for (std::size_t r = 0; r < sheet.rows.size(); ++r) add_row(data, r + 2, sheet.rows[r], false);
  add(root, "autoFilter",
      {{"ref", fmt::format("A1:{}{}", column_name(sheet.columns.size() - 1), sheet.rows.size() + 1)}});
  return xml_text(document);
}

/// Two looks of a cell: plain, and bold for heads.
std::string styles_text() {
  pugi::xml_document document = begun_xml();
  pugi::xml_node root = add(document, "styleSheet", {{"xmlns", kMain}});
  pugi::xml_node fonts = add(root, "fonts", {{"count", "2"}});
  for (const bool bold : {false, true}) {
    pugi::xml_node font = fonts.append_child("font");
    if (bold) font.append_child("b");
    add(font, "sz", {{"val", "11"}});
    add(font, "name", {{"val", "Calibri"}});
  }
  pugi::xml_node fills = add(root, "fills", {{"count", "2"}});
  for (const char* pattern : {"none", "gray125"})
    add(fills.append_child("fill"), "patternFill", {{"patternType", pattern}});
  add(root, "borders", {{"count", "1"}}).append_child("border");
  const Attributes plain = {{"numFmtId", "0"}, {"fontId", "0"}, {"fillId", "0"}, {"borderId", "0"}};
  add(add(root, "cellStyleXfs", {{"count", "1"}}), "xf", plain);
  pugi::xml_node looks = add(root, "cellXfs", {{"count", "2"}});
  for (const char* font : {"0", "1"})
    add(looks, "xf",
        {{"numFmtId", "0"},
         {"fontId", font},
         {"fillId", "0"},
         {"borderId", "0"},
         {"xfId", "0"},
         {"applyFont", "1"}});
  add(add(root, "cellStyles", {{"count", "1"}}), "cellStyle",
      {{"name", "Normal"}, {"xfId", "0"}, {"builtinId", "0"}});
  return xml_text(document);
}

std::string sheet_file(std::size_t k) {
  return fmt::format("worksheets/sheet{}.xml", k + 1);
}

std::string workbook_text(const std::vector<Sheet>& sheets) {
  pugi::xml_document document = begun_xml();
  pugi::xml_node root = add(document, "workbook", {{"xmlns", kMain}, {"xmlns:r", kOffice}});
  pugi::xml_node list = root.append_child("sheets");
  for (std::size_t k = 0; k < sheets.size(); ++k)
    add(list, "sheet",
        {{"name", sheets[k].name}, {"sheetId", fmt::to_string(k + 1)}, {"r:id", fmt::format("r{}", k + 1)}});
  return xml_text(document);
}

/// Which files belong to one; the kinds are those of the standard.
std::string relations_text(const std::vector<std::pair<std::string, std::string>>& kinds_and_files) {
  pugi::xml_document document = begun_xml();
  pugi::xml_node root = add(document, "Relationships", {{"xmlns", kRelations}});
  std::size_t number = 0;
  for (const auto& [kind, file] : kinds_and_files)
    add(root, "Relationship",
        {{"Id", fmt::format("r{}", ++number)},
         {"Type", fmt::format("{}/{}", kOffice, kind)},
         {"Target", file}});
  return xml_text(document);
}

std::string types_text(std::size_t sheets) {
  pugi::xml_document document = begun_xml();
  pugi::xml_node root = add(document, "Types", {{"xmlns", kTypes}});
  add(root, "Default",
      {{"Extension", "rels"}, {"ContentType", "application/vnd.openxmlformats-package.relationships+xml"}});
  add(root, "Default", {{"Extension", "xml"}, {"ContentType", "application/xml"}});
  const auto part = [&](const std::string& file, const char* kind) {
    add(root, "Override",
        {{"PartName", "/xl/" + file}, {"ContentType", fmt::format("{}{}+xml", kPart, kind)}});
  };
  part("workbook.xml", "sheet.main");
  part("styles.xml", "styles");
  for (std::size_t k = 0; k < sheets; ++k) part(sheet_file(k), "worksheet");
  return xml_text(document);
}

}  // namespace

SheetCell text_cell(std::string_view text) {
  return {as_utf8(text), false};
}

SheetCell number_cell(double value, int digits) {
  if (!std::isfinite(value)) return {};
  return {fmt::format("{:.{}f}", value, digits), true};
}

SheetCell short_number_cell(double value) {
  if (!std::isfinite(value)) return {};
  return {fmt::format("{:.3g}", value), true};
}

SheetCell count_cell(std::size_t count) {
  return {fmt::to_string(count), true};
}

std::string csv_line(const SheetRow& row) {
  std::string line;
  for (const SheetCell& cell : row) {
    if (&cell != &row.front()) line += ',';
    line += cell.number ? cell.text : csv_field(cell.text);
  }
  return line;
}

std::string csv_of(const Sheet& sheet) {
  std::string text = csv_line(head_of(sheet)) + "\r\n";
  for (const SheetRow& row : sheet.rows) text += csv_line(row) + "\r\n";
  return text;
}

std::string workbook_of(const std::vector<Sheet>& sheets) {
  std::vector<std::pair<std::string, std::string>> parts;
  for (std::size_t k = 0; k < sheets.size(); ++k) parts.emplace_back("worksheet", sheet_file(k));
  parts.emplace_back("styles", "styles.xml");
  std::vector<ZipFile> files = {{"[Content_Types].xml", types_text(sheets.size())},
                                {"_rels/.rels", relations_text({{"officeDocument", "xl/workbook.xml"}})},
                                {"xl/workbook.xml", workbook_text(sheets)},
                                {"xl/_rels/workbook.xml.rels", relations_text(parts)},
                                {"xl/styles.xml", styles_text()}};
  for (std::size_t k = 0; k < sheets.size(); ++k)
    files.push_back({"xl/" + sheet_file(k), sheet_text(sheets[k])});
  return zipped(files);
}

}  // namespace limen
