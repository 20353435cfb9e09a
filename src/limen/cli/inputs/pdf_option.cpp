// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/pdf_option.h"

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/report/html/print_pdf.h"

namespace limen {

void add_pdf_option(CommandLine& command, bool& pdf) {
  command.add_flag(
      "--pdf", pdf,
      "Print the report to report.pdf too, by the Chromium of this machine (LIMEN_CHROMIUM names one)");
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
        fmt::format("there is no report.pdf: {}; all other files are written and whole", error.what()));
  }
}

}  // namespace limen
