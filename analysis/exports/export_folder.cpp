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

/// The content of a folder's mark.
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

/// The file names, sorted, as in a mark.
std::set<std::string> names_of(const std::vector<ExportFile>& files) {
  std::set<std::string> names;
  for (const ExportFile& file : files) names.insert(file.name.generic_string());
  return names;
}

FolderMark mark_of(const fs::path& folder, const ExportMark& mark) {
  const fs::path path = folder / kExportMark;
  if (!is_there(path)) return {mark.study, mark.study_id, {}};
  FolderMark found = read_folder_mark(path);
  if (found.study_id == mark.study_id) return found;
  throw FileError(one_line(folder.string()) + ": holds an export of study " +
                  one_line(found.study) + " (" + one_line(found.study_id) +
                  "), not of this one; give another folder");
}

/// An export may replace a file that another format of this study wrote under the same name.
/// Datasets are the exception: two of them in one folder would leave neither valid.
void require_no_other_dataset(const fs::path& folder, const ExportMark& mark,
                              const FolderMark& found) {
  const auto is_dataset = [](const std::string& format) {
    return format == "bids" || format == "psych-ds";
  };
  for (const auto& [format, files] : found.files) {
    if (format == mark.format || files.empty()) continue;
    if (!is_dataset(format) && !is_dataset(mark.format)) continue;
    throw FileError(one_line(folder.string()) + ": holds this study's export as " + format +
                    ", and a dataset needs a folder of its own; give another folder");
  }
}

/// Whether a name stays inside the folder. The name comes from a mark file, which anybody may have
/// edited.
bool stays_inside(const std::string& name) {
  const fs::path path(name);
  return !path.empty() && path.is_relative() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
}

/// Checks all paths that will be written or removed.
/// \return the listed files whose file system cannot mark them as outputs
std::set<std::string> unmarked_files(const fs::path& folder, const FolderMark& found,
                                     const std::set<std::string>& names,
                                     const std::set<std::string>& before) {
  std::set<std::string> own;
  for (const auto& [format, files] : found.files) own.insert(files.begin(), files.end());
  std::set<std::string> unmarked;
  std::set<std::string> touched = names;
  std::ranges::copy_if(before, std::inserter(touched, touched.end()), stays_inside);
  for (const std::string& name : touched) {
    if (own.contains(name) && origin_of(folder / name) == Origin::unknown) {
      unmarked.insert(name);
    } else {
      require_output_place(folder / name);
    }
  }
  return unmarked;
}

/// Removes a file, and then the folders above it that are empty.
/// \throws FileError, naming the file, if it cannot be removed
void remove_obsolete(const fs::path& folder, const std::string& name) {
  clear_output_place(folder / name);
  std::error_code error;
  fs::remove(folder / name, error);
  if (error) {
    throw FileError(one_line((folder / name).string()) + ": is obsolete and cannot be removed (" +
                    error.message() + "); remove it");
  }
  for (fs::path above = fs::path(name).parent_path(); !above.empty(); above = above.parent_path()) {
    if (!fs::remove(folder / above, error)) return;
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
  FolderMark found = mark_of(folder, mark);
  const std::set<std::string> names = names_of(files);
  require_no_other_dataset(folder, mark, found);
  const std::set<std::string> before = found.files[mark.format];
  const std::set<std::string> unmarked = unmarked_files(folder, found, names, before);
  found.files[mark.format].insert(names.begin(), names.end());
  replace_file(folder / kExportMark, folder_mark_json(found));
  for (const std::string& name : unmarked) fs::remove(folder / name);
  write_all(folder, files);
  for (const std::string& name : before) {
    if (names.contains(name) || unmarked.contains(name)) continue;
    if (stays_inside(name)) remove_obsolete(folder, name);
  }
  found.files[mark.format] = names;
  replace_file(folder / kExportMark, folder_mark_json(found));
  std::vector<fs::path> written;
  for (const ExportFile& file : files) written.push_back(folder / file.name);
  return written;
}

}  // namespace touchtrial::analysis
