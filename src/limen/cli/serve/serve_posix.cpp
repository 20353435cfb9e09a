// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/folder_lock.h"
#include "limen/cli/serve/serve.h"
#include "limen/cli/serve/server.h"
#include "limen/cli/terminal/terminal.h"
#include "limen/report/json/json_values.h"

namespace limen {

void serve(const std::string& folder_name, int port, std::uint64_t most_upload, const Session& session) {
  const OutputFolder folder(folder_name);
  // Two would give their work the same numbers.
  const FolderLock lock(folder.path(), "is already served",
                        "open the page of that server, end that server, or give another folder");
  const LoopbackSocket socket(port);
  const Gate gate{new_token(), socket.port()};
  std::vector<std::string> common;
  if (session.common.threads != 0) common = {"--threads", fmt::format("{}", session.common.threads)};
  if (session.common.seed != CommonOptions{}.seed)
    common.insert(common.end(), {"--seed", fmt::format("{}", session.common.seed)});
  ServeSite site(std::filesystem::canonical(folder.path()), gate, most_upload, std::move(common));
  const std::string address = fmt::format("http://127.0.0.1:{}/{}/", socket.port(), gate.token);
  session.say(fmt::format(
      "open {}\nin a browser on this machine; whoever knows this address can use it. Ctrl-C ends it.\n",
      address));
  session.answer(to_text(Json{{"address", address}, {"folder", folder_name}}));
  if (session.common.quiet && !session.common.json) session.warn("open " + address);
  flush_out();
  serve_site(socket, site, [&] { return session.monitor->cancelled(); });
  session.say("ended; the results are in " + folder_name + "\n");
}

}  // namespace limen
