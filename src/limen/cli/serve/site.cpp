// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/site.h"

#include <array>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/version.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/serve/job_request.h"
#include "limen/files/bounded_json.h"
#include "limen/files/mapped_file.h"
#include "limen/files/text_numbers.h"
#include "limen/io/cloud/open_points.h"
#include "limen/report/html/print_pdf.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJsonType = "application/json";
/// Our own page: nothing from elsewhere, nothing inline, in no frame.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// Pages of results bring a policy of their own. In a sandbox they have no origin, and can ask nothing here.
constexpr const char* kResultPolicy =
    "sandbox allow-scripts allow-downloads allow-modals; frame-ancestors 'none'";

HttpReply json_reply(const Json& json, int status = 200) {
  HttpReply reply;
  reply.status = status;
  reply.type = kJsonType;
  reply.body = to_text(json) + "\n";
  return reply;
}

std::string type_of(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 7> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".json", kJsonType},
      {".geojson", kJsonType},
      {".svg", "image/svg+xml"},
      {".txt", "text/plain; charset=utf-8"},
      {".csv", "text/csv; charset=utf-8"},
      {".pdf", "application/pdf"},
  }};
  for (const auto& [ending, type] : kTypes) {
    if (name.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

bool has_browser() {
  try {
    return !find_chromium().empty();
  } catch (const Error&) {
    return false;
  }
}

/// RFC 6266 and 8187: bytes beyond what every reader takes are encoded.
std::string download_as(const std::string& name) {
  std::string encoded;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '.' || c == '_' || c == '-';
    encoded += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return "attachment; filename*=UTF-8''" + encoded;
}

/// A plain file of a folder; not what a link points to.
HttpReply open_file(const fs::path& folder, const std::string& name) {
  if (!is_safe_name(name)) throw HttpFault(404, "there is no such file");
  const int file = open((folder / name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) throw HttpFault(404, "there is no such file");
  struct stat status {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(file);
    throw HttpFault(404, "there is no such file");
  }
  HttpReply reply;
  reply.file = file;
  reply.file_bytes = static_cast<std::uint64_t>(status.st_size);
  return reply;
}

std::optional<int> number_in(const std::string& text) {
  const std::optional<std::size_t> number = parse_count(text);
  if (!number || *number > 1'000'000'000 || text.find_first_not_of("0123456789") != std::string::npos)
    return {};
  return static_cast<int>(*number);
}

[[noreturn]] void refuse_second() {
  throw HttpFault(409, "a file of this name exists: remove it, or give this one another name");
}

/// A file that appears under its name once all of it has come.
class FileUpload : public HttpUpload {
 public:
  FileUpload(const fs::path& path, std::string name) : file_(path), path_(path), name_(std::move(name)) {}
  void write(const std::string& bytes) override { file_.write(bytes); }
  HttpReply finish() override {
    std::error_code unknown;
    if (fs::exists(path_, unknown)) refuse_second();  // another upload of this name was faster
    file_.commit();
    try {
      if (!is_bim_file(path_)) point_format_of(MappedFile(path_.string()).bytes(), path_);
    } catch (const Error& error) {
      std::error_code ignored;
      fs::remove(path_, ignored);
      throw HttpFault(415, fmt::format("{}: {}", error.problem(), error.remedy()));
    }
    return json_reply({{"name", name_}}, 201);
  }

 private:
  AtomicFile file_;
  fs::path path_;
  std::string name_;
};

[[noreturn]] void nothing_there() {
  throw HttpFault(404, "there is nothing here");
}

}  // namespace

ServeSite::ServeSite(fs::path folder, Gate gate, std::uint64_t most_upload_bytes,
                     std::vector<std::string> common_words)
    : folder_(std::move(folder)),
      gate_(std::move(gate)),
      most_upload_bytes_(most_upload_bytes),
      prints_(has_browser()),
      jobs_(folder_, std::move(common_words)) {
  std::error_code fault;
  for (const char* part : {"files", "results"}) {
    fs::create_directories(folder_ / part, fault);
    if (fault || fs::is_symlink(folder_ / part))
      throw Error("cannot be used", (folder_ / part).string(), "give a folder of its own to limen serve");
    const OutputFolder swept(folder_ / part);  // of what a killed server left half written
  }
}

std::unique_ptr<HttpUpload> ServeSite::begin(const HttpRequest& request) {
  gate_.check(request);
  const std::vector<std::string>& path = request.segments;
  if (request.method != "PUT") {
    if (request.content_bytes > kMostBody) throw HttpFault(413, "the request is too large");
    return nullptr;
  }
  if (path.size() != 3 || path[1] != "files") throw HttpFault(405, "files are put to files/NAME");
  if (!is_safe_name(path[2]))
    throw HttpFault(
        400,
        "this file name is not allowed: choose one without / and spaces that does not begin with a point");
  if (!request.has_content) throw HttpFault(411, "the length of the file is missing");
  if (request.content_bytes > most_upload_bytes_)
    throw HttpFault(413,
                    fmt::format("the file is too large: at most {} bytes can be uploaded (--most-upload)",
                                most_upload_bytes_));
  std::error_code unknown;
  if (fs::exists(folder_ / "files" / path[2], unknown)) refuse_second();
  const fs::space_info space = fs::space(folder_ / "files", unknown);
  if (!unknown && space.available < request.content_bytes)
    throw HttpFault(507, "the disk has not enough free space for it");
  try {
    return std::make_unique<FileUpload>(folder_ / "files" / path[2], path[2]);
  } catch (const Error& error) {
    throw HttpFault(507, error.what());
  }
}

HttpReply ServeSite::answer(const HttpRequest& request, const std::string& body) {
  const std::vector<std::string>& path = request.segments;
  const bool reading = request.method == "GET" || request.method == "HEAD";
  if (path.size() == 1) nothing_there();
  if (path.size() == 2 && reading) return path[1] == "state" ? state() : page_part(path[1]);
  if (path.size() == 2 && path[1] == "jobs" && request.method == "POST") return take_job(body);
  if (path.size() == 3 && path[1] == "files") return uploaded_file(request);
  if (path.size() == 4 && path[1] == "results" && reading) return result_file(request);
  if (path.size() == 4 && path[1] == "jobs" && request.method == "POST") return change_job(request);
  if (path.size() == 2 && path[1] == "jobs") throw HttpFault(405, "work is posted");
  nothing_there();
}

HttpReply ServeSite::state() const {
  Json json = {{"version", kVersion},
               {"folder", folder_.filename().string()},
               {"most_upload_bytes", most_upload_bytes_},
               {"prints", prints_},
               {"files", served_files_json(served_files(folder_ / "files"))},
               {"jobs", jobs_.as_json()}};
  return json_reply(json);
}

HttpReply ServeSite::page_part(const std::string& name) const {
  HttpReply reply;
  reply.fields = {{"Content-Security-Policy", kPagePolicy}};
  if (name.empty()) {
    reply.type = "text/html; charset=utf-8";
    reply.body = serve_page_html();
  } else if (name == "serve.css") {
    reply.type = "text/css; charset=utf-8";
    reply.body = serve_page_css();
  } else if (name == "serve.js") {
    reply.type = "text/javascript; charset=utf-8";
    reply.body = serve_page_js();
  } else {
    nothing_there();
  }
  return reply;
}

HttpReply ServeSite::uploaded_file(const HttpRequest& request) {
  const std::string& name = request.segments[2];
  HttpReply reply = open_file(folder_ / "files", name);
  if (request.method == "GET" || request.method == "HEAD") {
    // What was brought from outside is never shown as a page of ours.
    reply.type = "application/octet-stream";
    reply.fields = {{"Content-Disposition", download_as(name)}, {"Content-Security-Policy", kResultPolicy}};
    return reply;
  }
  close(reply.file);
  if (request.method != "DELETE") throw HttpFault(405, "files are put, got or deleted");
  if (jobs_.uses("files/" + name)) throw HttpFault(409, "a job that has not ended needs this file");
  std::error_code fault;
  if (!fs::remove(folder_ / "files" / name, fault)) throw HttpFault(500, "the file cannot be removed");
  return json_reply({{"removed", name}});
}

HttpReply ServeSite::result_file(const HttpRequest& request) const {
  const std::optional<int> id = number_in(request.segments[2]);
  const std::string& name = request.segments[3];
  if (!id || fs::is_symlink(jobs_.results_of(*id))) nothing_there();
  HttpReply reply = open_file(jobs_.results_of(*id), name);
  reply.type = type_of(name);
  reply.fields = {{"Content-Security-Policy", kResultPolicy}};
  if (reply.type == "application/octet-stream")
    reply.fields.emplace_back("Content-Disposition", download_as(name));
  return reply;
}

HttpReply ServeSite::take_job(const std::string& body) {
  const Json json = json_or_nothing<Json>(body);
  if (json.is_object() && json.value("kind", Json()) == "again") {
    const Json of = json.value("of", Json());
    const int id = of.is_number_integer() ? of.get<int>() : 0;
    PageJob job = job_from_request(jobs_.job(id).asked, folder_, jobs_, id);
    if (job.kind != "project") throw HttpFault(409, "only projects are run again");
    jobs_.again(id, std::move(job.words));
    return json_reply({{"id", id}}, 202);
  }
  const int id = jobs_.next_id();
  jobs_.add(job_from_request(json, folder_, jobs_, id));
  return json_reply({{"id", id}}, 202);
}

HttpReply ServeSite::change_job(const HttpRequest& request) {
  const std::optional<int> id = number_in(request.segments[2]);
  if (!id || request.segments[3] != "stop") nothing_there();
  jobs_.stop(*id);
  return json_reply({{"id", *id}}, 202);
}

HttpReply reply_to(const HttpFault& fault) {
  return json_reply({{"error", fault.what()}}, fault.status);
}

}  // namespace limen
