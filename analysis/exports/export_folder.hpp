/// \file Writes exports into a folder of one study, and removes obsolete files.
#pragma once

#include "core/files.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// One file of an export.
struct ExportFile {
  std::filesystem::path name;  ///< relative to the export's folder
  /// Writes the whole file as an output, or throws. The file's folder exists.
  std::function<void(const std::filesystem::path&)> write;
  /// Whether `write` is slow and may run on any thread, concurrently with other such files.
  bool concurrent = false;
};

/// A file whose content is generated when it is written.
[[nodiscard]] ExportFile text_file(std::filesystem::path name,
                                   std::function<std::string()> content);
/// A file with this content.
[[nodiscard]] ExportFile text_file(std::filesystem::path name, std::string content,
                                   FileMode mode = FileMode::everyone);

/// The study and the format of an export.
struct ExportMark {
  std::string study;     ///< name
  std::string study_id;  ///< public identity of the study's key
  std::string format;    ///< for instance "csv"
};

/// The file name of a folder's mark.
inline constexpr const char* kExportMark = ".touchtrial-export.json";

/// Writes every file atomically into a folder, which it creates if necessary. Then removes obsolete
/// files: files of the last export of this format that this export does not include (for example,
/// because a participant's data were erased since). A mark in the folder lists the files. It is
/// updated before the first file is written, so that an interrupted export can be repeated.
/// Concurrent files are written last, on all cores.
/// \return the files, in the order given
/// \throws FileError if the folder or a file cannot be written
/// \throws FileError, before anything is written, if the folder contains the export of another
///   study
/// \throws as require_output_path does, before anything is written
std::vector<std::filesystem::path> write_export(const std::filesystem::path& folder,
                                                const ExportMark& mark,
                                                const std::vector<ExportFile>& files);

}  // namespace touchtrial::analysis
