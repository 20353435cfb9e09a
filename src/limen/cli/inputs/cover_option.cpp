// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/cover_option.h"

#include <string_view>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/files/mapped_file.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/print_pdf.h"

namespace limen {

void add_pdf_option(CommandLine& command, bool& pdf) {
  command.add_flag("--pdf", pdf,
                   "Print the report to report.pdf too, with the Chromium of this machine or the one that "
                   "LIMEN_CHROMIUM names");
}

std::filesystem::path browser_for_pdf(bool pdf) {
  return pdf ? find_chromium() : std::filesystem::path();
}

void write_pdf(const std::filesystem::path& browser, const std::filesystem::path& folder,
               const Session& session) {
  if (!std::filesystem::exists(folder / "report.html")) return;
  session.monitor->begin_stage("printing");
  try {
    print_pdf(browser, folder / "report.html", folder / "report.pdf", *session.monitor);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    session.warn(
        fmt::format("report.pdf could not be written: {}; all other files are complete", error.what()));
  }
}

namespace {

constexpr std::size_t kLargestLogo = 2'000'000;  // bytes; it becomes a part of each page
constexpr std::size_t kSvgHead = 1'000;          // bytes in which an SVG names itself

/// By its first bytes; empty where it is no image that pages show.
std::string_view image_type(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n"sv)) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff"sv)) return "image/jpeg";
  if (bytes.substr(0, kSvgHead).find("<svg") != std::string_view::npos) return "image/svg+xml";
  return {};
}

std::string image_uri(const std::string& path) {
  const char* remedy = "give a PNG, JPEG or SVG of at most 2 MB";
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  if (bytes.size() > kLargestLogo) throw Error("is too large for a logo", path, remedy);
  const std::string_view type = image_type(bytes);
  if (type.empty()) throw Error("is no image that can be a logo", path, remedy);
  return "data:" + std::string(type) + ";base64," + base64({bytes.begin(), bytes.end()});
}

}  // namespace

bool CoverChoice::empty() const {
  return (cover.title + cover.project + cover.operator_name + cover.date + logo).empty() && language == "en";
}

void add_cover_options(CommandLine& command, CoverChoice& choice) {
  const auto add = [&command](const char* name, std::string& text, const char* description,
                              const char* type = "WORDS") {
    command.add_option(name, text, description)->type_name(type);
  };
  add("--title", choice.cover.title, "Title of the report");
  add("--project", choice.cover.project, "Project that the report names");
  add("--operator", choice.cover.operator_name, "Who made the registration, for the report");
  add("--date", choice.cover.date, "Date on the report, printed as given");
  add("--logo", choice.logo, "Logo on the report: PNG, JPEG or SVG, at most 2 MB", "FILE");
  command
      .add_option("--language", choice.language,
                  "Language of the report (of limen register: of a summary on it): en (default), fr or de")
      ->one_of({"en", "fr", "de"});
}

ReportCover cover_of(const CoverChoice& choice) {
  ReportCover cover = choice.cover;
  cover.language = choice.language == "fr"   ? Language::french
                   : choice.language == "de" ? Language::german
                                             : Language::english;
  if (!choice.logo.empty()) cover.logo = image_uri(choice.logo);
  return cover;
}

}  // namespace limen
