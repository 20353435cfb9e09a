// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/pdf_option.h"

#include <fmt/format.h>

#include "limen/base/error.h"
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

}  // namespace limen
