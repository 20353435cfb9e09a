// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limen/cli/serve/gate.h"
#include "limen/cli/serve/http_request.h"
#include "limen/cli/serve/jobs.h"

namespace limen {

/// The parts of the page of `limen serve`, made of serve/page at build time.
std::string_view serve_page_html();
std::string_view serve_page_css();
std::string_view serve_page_js();

/// What is answered: a text, or a file that is open.
struct HttpReply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::vector<std::pair<std::string, std::string>> fields = {};
  int file = -1;                 ///< a descriptor that whoever sends it closes; -1: the body is all
  std::uint64_t file_bytes = 0;  ///< of it
};

/// Where the body of an upload goes.
class HttpUpload {
 public:
  virtual ~HttpUpload() = default;
  virtual void write(const std::string& bytes) = 0;
  virtual HttpReply finish() = 0;  ///< once all of it has come
};

/// The page of `limen serve` and what it asks for. Below the token:
///   GET  (nothing), serve.css, serve.js   the page
///   GET  state                            files, work and its progress, as JSON
///   PUT, GET, DELETE files/NAME           the files that were dropped on it
///   POST jobs                             work to do, as JSON
///   POST jobs/ID/stop                     that ends it
///   GET  results/ID/NAME                  what it wrote
/// Nothing of the folder but plain files in files/ and results/ID/ can be reached.
class ServeSite {
 public:
  /// `folder` exists; files/ and results/ are made in it. `common_words`: options that every job gets.
  ServeSite(std::filesystem::path folder, Gate gate, std::uint64_t most_upload_bytes,
            std::vector<std::string> common_words = {});

  /// Looks at the head of a request. Where it uploads a file: what takes its bytes; else nothing, and the
  /// body, of at most kMostBody bytes, goes to answer(). Throws HttpFault for whatever is not allowed.
  std::unique_ptr<HttpUpload> begin(const HttpRequest& request);
  HttpReply answer(const HttpRequest& request, const std::string& body);

  static constexpr std::uint64_t kMostBody = 65536;

  [[nodiscard]] JobBoard& jobs() { return jobs_; }

 private:
  HttpReply state() const;
  HttpReply page_part(const std::string& name) const;
  HttpReply uploaded_file(const HttpRequest& request);
  HttpReply result_file(const HttpRequest& request) const;
  HttpReply take_job(const std::string& body);
  HttpReply change_job(const HttpRequest& request);

  std::filesystem::path folder_;
  Gate gate_;
  std::uint64_t most_upload_bytes_;
  bool prints_;  ///< a browser that can print is on this machine
  JobBoard jobs_;
};

/// What is reported of a fault.
HttpReply reply_to(const HttpFault& fault);

}  // namespace limen
