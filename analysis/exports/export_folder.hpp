/// \file Where exports go: a folder holds one study's, and nothing of it that has become obsolete.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One file of an export.
struct ExportFile {
  std::filesystem::path name;  ///< below the export's folder
  /// Makes the file whole or throws; its folder exists.
  std::function<void(const std::filesystem::path&)> write;
  /// Its writing takes long, and may run on any thread beside that of other such files.
  bool concurrent = false;
};

/// One whose content is made when its turn comes.
[[nodiscard]] ExportFile text_file(std::filesystem::path name,
                                   std::function<std::string()> content);
/// One whose content is there.
[[nodiscard]] ExportFile text_file(std::filesystem::path name, std::string content);

/// Whose export it is.
struct ExportMark {
  std::string study;     ///< name
  std::string study_id;  ///< public identity of its key
  std::string format;    ///< for instance "csv"
};

/// What a folder's mark is called.
inline constexpr const char* kExportMark = ".touchtrial-export.json";

/// Writes every file, each atomically, into a folder that is made if need be, and then removes what
/// the last export of this format wrote there and this one does not hold (of a participant who
/// withdrew since, for instance). A mark in the folder keeps the list, and is brought up to date
/// before the first file is written, so that a broken-off export can be repeated. Files that are
/// concurrent are written last, as many at a time as there are cores.
/// \return the files, in the order given
/// \throws FileError if the folder or a file cannot be written, holds another study's export, or
/// has
///   a file of one of these names that no export of this study wrote; nothing is written then
std::vector<std::filesystem::path> write_export(const std::filesystem::path& folder,
                                                const ExportMark& mark,
                                                const std::vector<ExportFile>& files);

}  // namespace touchtrial::analysis
