/// \file The mark of a folder that holds exports, as JSON. Private to exports.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace touchtrial::analysis {

struct FolderMark {
  std::string study;
  std::string study_id;
  std::map<std::string, std::set<std::string>> files{};  ///< file names by format
};

[[nodiscard]] std::string folder_mark_json(const FolderMark& mark);
/// \throws FileError if the file is not a mark
[[nodiscard]] FolderMark read_folder_mark(const std::filesystem::path& path);

}  // namespace touchtrial::analysis
