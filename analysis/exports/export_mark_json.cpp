#include "analysis/exports/export_mark_json.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

std::string folder_mark_json(const FolderMark& mark) {
  const nlohmann::json object{
      {"study", mark.study}, {"study_id", mark.study_id}, {"files", mark.files}};
  return object.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

FolderMark read_folder_mark(const std::filesystem::path& path) {
  try {
    const nlohmann::json object = nlohmann::json::parse(text_of(ByteView(read_file(path))));
    FolderMark mark;
    object.at("study").get_to(mark.study);
    object.at("study_id").get_to(mark.study_id);
    object.at("files").get_to(mark.files);
    return mark;
  } catch (const nlohmann::json::exception&) {
    throw FileError(one_line(path.string()) +
                    ": is no mark of an export; give another folder, or remove that file");
  }
}

}  // namespace touchtrial::analysis
