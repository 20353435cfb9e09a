// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/help/program_doc.h"

#include <algorithm>
#include <map>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/cli/terminal/command.h"

namespace limen {
namespace {

/// "TEXT:{a,b}": the choices; none where there is no such list.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

ValueKind kind_of(const std::string& word) {
  if (word == "FILE" || word == "SCAN POSE") return ValueKind::file;
  return word == "DIR" ? ValueKind::folder : ValueKind::text;
}

std::string first_word_kind(const std::string& type) {
  return type.substr(0, type.find(':'));
}

OptionDoc describe_option(const CLI::Option& option) {
  OptionDoc doc;
  const std::string type = option.get_type_name();
  const std::string word = first_word_kind(type);
  doc.positional = !option.nonpositional();
  doc.description = option.get_description();
  doc.required = option.get_required();
  doc.common = option.get_group() == kCommonGroup || option.get_lnames() == std::vector<std::string>{"help"};
  if (doc.positional) {
    doc.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) doc.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) doc.names.push_back("--" + name);
  }
  if (option.get_items_expected_max() == 0) return doc;
  doc.choices = choices_in(type);
  // Positional arguments are files unless they have a list of choices.
  const bool file = doc.positional && (doc.choices.empty() || word == "FILE");
  doc.kind = file ? ValueKind::file : kind_of(word);
  doc.value = doc.choices.empty() || file ? word : fmt::format("{}", fmt::join(doc.choices, "|"));
  return doc;
}

const std::vector<ExampleDoc>& examples_of(const std::string& command) {
  static const std::map<std::string, std::vector<ExampleDoc>> examples = {
      {"",
       {{"Register a room with the street outside and move its cloud there",
         "limen register room.ply street.ply -o result\n"
         "limen transform result/result.json room.ply room_in_street.ply"},
        {"Try it without data of your own", "limen simulate museum -o museum"}}},
      {"info",
       {{"What is in a file", "limen info room.ply"},
        {"Only the number of points, for a script", "limen info room.ply --json | jq '.scans[0].points'"}}},
      {"planes", {{"Planes and their outlines", "limen planes room.ply -o planes.json"}}},
      {"openings",
       {{"Windows and doors of a scan whose file does not state the scanner position",
         "limen openings room.xyz --origin 1.2,-0.4,1.6 -o openings.json"}}},
      {"segments",
       {{"Edges of a scan", "limen segments room.ply -o edges.json"},
        {"Exact edges of a model", "limen segments house.ifc -o edges.json"}}},
      {"register",
       {{"Two scans", "limen register room.ply street.ply -o result"},
        {"A scan in a building model", "limen register room.ply house.ifc -o result"},
        {"Two stations of one floor with known relative pose, and the street",
         "limen register a.ply street.ply --source-with b.ply a_from_b.txt -o result"}}},
      {"project",
       {{"All stations of a building, whatever their order",
         "limen project scans/*.e57 street.las -o building"},
        {"How far a project has come", "limen project status building"},
        {"Answers: accept, reject, choose A B N, level A, same-floor A B, forget A B",
         "limen project decide building accept hall.e57 stairs.e57"},
        {"All scans in the common frame", "limen transform building/project.json -o placed"}}},
      {"transform",
       {{"Move a cloud into the target's frame",
         "limen transform result/result.json room.ply room_in_street.ply"},
        {"Both clouds in one file",
         "limen transform result/result.json room.e57 both.e57 --merge street.laz"},
        {"All scans of a project (options: limen transform -o OUT --help)",
         "limen transform building/project.json -o placed"}}},
      {"thin",
       {{"Two million points of a file of any size", "limen thin street.laz street_2M.laz --points 2000000"},
        {"One point per centimetre", "limen thin room.e57 room.ply --spacing-m 0.01"}}},
      {"view",
       {{"A building with all its scans, for a browser", "limen view building/project.json -o building.html"},
        {"A scan and a model in one frame", "limen view room.ply house.ifc"}}},
      {"serve", {{"A page to drop scans on and to register them", "limen serve building"}}},
      {"evaluate",
       {{"Compare with the truth of a simulated case",
         "limen evaluate result/result.json museum/truth/truth.json"}}},
      {"deviation",
       {{"Where the building deviates from its model",
         "limen deviation room.ply house.ifc --result result/result.json -o deviation"}}},
      {"simulate",
       {{"A museum from inside and from the street, twice as dense as usual",
         "limen simulate museum --points-indoor 600000 -o museum"},
        {"A room of a model, with elements moved and missing",
         "limen simulate house.ifc --as-built -o site"}}},
      {"schema",
       {{"The JSON Schema of result.json", "limen schema result > result.schema.json"},
        {"The JSON Schema of a building's project.json", "limen schema project > project.schema.json"}}},
      {"completion",
       {{"For this shell session", "source <(limen completion bash)"},
        {"For every fish session", "limen completion fish > ~/.config/fish/completions/limen.fish"}}},
  };
  static const std::vector<ExampleDoc> none;
  const auto found = examples.find(command);
  return found == examples.end() ? none : found->second;
}

}  // namespace

std::string typed_name(const CLI::App& command) {
  return command.get_name() == kProjectMove ? "transform" : command.get_name();
}

CommandDoc describe_command(const CLI::App& app) {
  CommandDoc doc;
  const bool root = app.get_parent() == nullptr;
  doc.name = root ? "" : typed_name(app);
  doc.description = app.get_description();
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) doc.options.push_back(describe_option(*option));
  }
  std::stable_partition(doc.options.begin(), doc.options.end(),
                        [](const OptionDoc& option) { return option.positional; });
  std::stable_partition(doc.options.begin(), doc.options.end(),
                        [](const OptionDoc& option) { return option.positional || !option.common; });
  doc.examples = examples_of(doc.name);
  return doc;
}

ProgramDoc describe_program(const CLI::App& app) {
  ProgramDoc doc;
  doc.program = describe_command(app);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) doc.commands.push_back(describe_command(*command));
  }
  return doc;
}

std::vector<StatusDoc> status_docs() {
  return {
      {kExitOk, "Done; for register: registered; for project: all scans registered in one frame."},
      {kExitInternal, "An internal error of limen: please report it."},
      {kExitBadInput, "A file, a value or an option was wrong; one line on stderr says which."},
      {kExitUndecided,
       "For register: probable, ambiguous, or under-constrained; for project: some scans are not "
       "registered."},
      {kExitNoMatch,
       "For register and project: no reliable overlap was found; for deviation: no point lies on the model."},
      {kExitInterrupted, "Interrupted; nothing was written."}};
}

std::string OptionDoc::text() const {
  const bool stated = std::all_of(choices.begin(), choices.end(), [this](const std::string& choice) {
    return description.find(choice) != std::string::npos;
  });
  return stated ? description : fmt::format("{}: {}", description, fmt::join(choices, ", "));
}

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines;
  std::string line;
  for (const std::string& word : CLI::detail::split(text, ' ')) {
    if (!line.empty() && line.size() + 1 + word.size() > columns) {
      lines.push_back(line);
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  lines.push_back(line);
  return lines;
}

}  // namespace limen
