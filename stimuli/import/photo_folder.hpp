/// \file Which photographs a folder holds and what they are called. Private to stimuli/import.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::stimuli {

/// The photographs of one label, in natural order of their names.
struct PhotoClass {
  std::string label;
  std::vector<std::filesystem::path> files;
};

struct PhotoFolder {
  std::vector<PhotoClass> classes;   ///< in natural order of their labels
  std::vector<std::string> ignored;  ///< names of other files
};

/// A folder of folders: each is a class of its name. A folder of files: each is a class of its
/// stem, as in an album of D1.png, D2.png, ... Hidden files and folders do not count; files whose
/// endings are no picture's are ignored.
/// \throws FileError if it is no folder, is empty, has pictures beside folders, or has a name that
///   cannot be a label or is another's but for capitals
[[nodiscard]] PhotoFolder list_photographs(const std::filesystem::path& folder);

/// Whether `a` stands before `b` where numbers count as numbers: D2 before D10.
[[nodiscard]] bool naturally_before(const std::string& a, const std::string& b);

/// Whether a text can go into a JSON file.
[[nodiscard]] bool is_utf8(const std::string& text);

}  // namespace touchtrial::stimuli
