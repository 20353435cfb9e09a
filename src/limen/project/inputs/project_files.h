// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/project/inputs/project_options.h"
#include "limen/project/store/store.h"

namespace limen {

/// A file of a project.
struct ProjectFile {
  std::string path;  ///< as the user wrote it
  bool model = false;
  std::string sha256;   ///< empty where it cannot be read
  std::string copy_of;  ///< the first file with the same bytes, taken as the same; empty: none
  std::string fault;    ///< why it cannot be read, in words; empty: it can
  int scan = -1;        ///< the one scan of it that the path names (files/scan_in_file.h); -1: all

  /// As the store knows it.
  [[nodiscard]] FileKey key() const { return {sha256, model, scan}; }
};

struct ProjectFiles {
  std::vector<ProjectFile> files;  ///< by name, each path once
  std::vector<std::string> notes;

  /// The name of a scan by the file as it was given, where the name means one of the files alone; else
  /// itself.
  [[nodiscard]] std::string full_name(const std::string& name) const;
};

/// The files in an order that does not depend on how they were given, with their hashes. Scans that turn out
/// to be models are taken as such.
ProjectFiles list_files(const ProjectInputs& inputs, Monitor& monitor);

/// Whether the first line of a text that is no comment names a file, as in a list for --scans.
bool lists_files(const std::string& path);

/// Text that is compared number by number: "scan 2" comes before "scan 10".
bool comes_before(const std::string& a, const std::string& b);

}  // namespace limen
