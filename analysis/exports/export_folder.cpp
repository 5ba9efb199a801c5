#include "analysis/exports/export_folder.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <system_error>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

namespace fs = std::filesystem;

struct FolderMark {
  std::string study;
  std::string study_id;
  std::map<std::string, std::set<std::string>> files{};  ///< file names by format
};

std::string folder_mark_json(const FolderMark& mark) {
  const nlohmann::json object{
      {"study", mark.study}, {"study_id", mark.study_id}, {"files", mark.files}};
  return object.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// \throws FileError if the file is not a mark
FolderMark read_folder_mark(const fs::path& path) {
  try {
    const nlohmann::json object = nlohmann::json::parse(text_of(ByteView(read_file(path))));
    FolderMark mark;
    object.at("study").get_to(mark.study);
    object.at("study_id").get_to(mark.study_id);
    object.at("files").get_to(mark.files);
    return mark;
  } catch (const nlohmann::json::exception&) {
    throw FileError(one_line(path.string()) +
                    ": is not an export's mark file; give another folder, or remove that file");
  }
}

void make_export_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::is_directory(folder)) return;
  const std::string reason = error ? error.message() : "a file of that name exists";
  throw FileError(one_line(folder.string()) + ": cannot create the folder (" + reason +
                  "); give another folder or change its permissions");
}

std::set<std::string> names_of(const std::vector<ExportFile>& files) {
  std::set<std::string> names;
  for (const ExportFile& file : files) names.insert(file.name.generic_string());
  return names;
}

FolderMark read_own_mark(const fs::path& folder, const ExportMark& mark) {
  const fs::path path = folder / kExportMark;
  if (!path_exists(path)) return {mark.study, mark.study_id, {}};
  FolderMark folder_mark = read_folder_mark(path);
  if (folder_mark.study_id == mark.study_id) return folder_mark;
  throw FileError(one_line(folder.string()) + ": holds an export of study " +
                  one_line(folder_mark.study) + " (" + one_line(folder_mark.study_id) +
                  "), not of this one; give another folder");
}

/// Formats may share a folder and replace each other's files of the same name. Two datasets in one
/// folder would leave neither valid.
void require_no_other_dataset(const fs::path& folder, const ExportMark& mark,
                              const FolderMark& folder_mark) {
  const auto is_dataset = [](const std::string& format) {
    return format == "bids" || format == "psych-ds";
  };
  for (const auto& [format, files] : folder_mark.files) {
    if (format == mark.format || files.empty()) continue;
    if (!is_dataset(format) && !is_dataset(mark.format)) continue;
    throw FileError(one_line(folder.string()) + ": holds this study's export as " + format +
                    ", and a dataset needs its own folder; give another folder");
  }
}

/// Whether a name is inside the folder. It comes from a mark file, which may have been edited.
bool is_inside_folder(const std::string& name) {
  const fs::path path(name);
  return !path.empty() && path.is_relative() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
}

/// Checks all paths that will be written or removed.
/// \return the listed files whose file system cannot mark outputs
std::set<std::string> unmarked_files(const fs::path& folder, const FolderMark& folder_mark,
                                     const std::set<std::string>& names,
                                     const std::set<std::string>& previous) {
  std::set<std::string> listed_names;
  for (const auto& [format, files] : folder_mark.files)
    listed_names.insert(files.begin(), files.end());
  std::set<std::string> unmarked;
  std::set<std::string> checked_names = names;
  std::ranges::copy_if(previous, std::inserter(checked_names, checked_names.end()),
                       is_inside_folder);
  for (const std::string& name : checked_names) {
    if (listed_names.contains(name) && origin_of(folder / name) == Origin::unknown) {
      unmarked.insert(name);
    } else {
      require_output_path(folder / name);
    }
  }
  return unmarked;
}

/// Removes a file, then its parent folders that are empty.
/// \throws FileError, naming the file, if it cannot be removed
void remove_obsolete(const fs::path& folder, const std::string& name) {
  clear_output_path(folder / name);
  std::error_code error;
  fs::remove(folder / name, error);
  if (error) {
    throw FileError(one_line((folder / name).string()) + ": is obsolete and cannot be removed (" +
                    error.message() + "); remove it");
  }
  for (fs::path parent = fs::path(name).parent_path(); !parent.empty();
       parent = parent.parent_path()) {
    if (!fs::remove(folder / parent, error)) return;
  }
}

void write_one(const fs::path& folder, const ExportFile& file) {
  const fs::path path = folder / file.name;
  make_folder(path.parent_path());
  file.write(path);
}

void write_all(const fs::path& folder, const std::vector<ExportFile>& files) {
  std::vector<const ExportFile*> concurrent;
  for (const ExportFile& file : files) {
    if (file.concurrent) {
      concurrent.push_back(&file);
    } else {
      write_one(folder, file);
    }
  }
  in_parallel(0, concurrent.size(), [&](std::size_t i) { write_one(folder, *concurrent[i]); });
}

}  // namespace

ExportFile text_file(fs::path name, std::function<std::string()> content) {
  return {std::move(name), [content = std::move(content)](const fs::path& path) {
            write_output(path, std::string_view(content()));
          }};
}

ExportFile text_file(fs::path name, std::string content, FileMode mode) {
  return {std::move(name), [content = std::move(content), mode](const fs::path& path) {
            write_output(path, std::string_view(content), mode);
          }};
}

std::vector<fs::path> write_export(const fs::path& folder, const ExportMark& mark,
                                   const std::vector<ExportFile>& files) {
  make_export_folder(folder);
  FolderMark folder_mark = read_own_mark(folder, mark);
  const std::set<std::string> names = names_of(files);
  require_no_other_dataset(folder, mark, folder_mark);
  const std::set<std::string> previous = folder_mark.files[mark.format];
  const std::set<std::string> unmarked = unmarked_files(folder, folder_mark, names, previous);
  folder_mark.files[mark.format].insert(names.begin(), names.end());
  replace_file(folder / kExportMark, folder_mark_json(folder_mark));
  for (const std::string& name : unmarked) fs::remove(folder / name);
  write_all(folder, files);
  for (const std::string& name : previous) {
    if (names.contains(name) || unmarked.contains(name)) continue;
    if (is_inside_folder(name)) remove_obsolete(folder, name);
  }
  folder_mark.files[mark.format] = names;
  replace_file(folder / kExportMark, folder_mark_json(folder_mark));
  std::vector<fs::path> written;
  for (const ExportFile& file : files) written.push_back(folder / file.name);
  return written;
}

}  // namespace touchtrial::analysis
