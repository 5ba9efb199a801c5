#include "protocols/design/prepare.hpp"

namespace touchtrial::design {
namespace {

std::filesystem::path beside(const std::filesystem::path& study_file, const char* ending) {
  return study_file.parent_path() / (study_file.stem().string() + ending);
}

}  // namespace

PackPlace default_pack_place(const std::filesystem::path& study_file) {
  return {beside(study_file, ".pack"), beside(study_file, ".key")};
}

PackPlace simulated_pack_place(const std::filesystem::path& study_file) {
  return {beside(study_file, ".sim.pack"), {}};
}

PackPlace pack_place_at(const std::filesystem::path& pack_folder) {
  // "name.pack/" ends in an empty file name; the folder is what comes before.
  const auto pack = pack_folder.has_filename() ? pack_folder : pack_folder.parent_path();
  std::filesystem::path key = pack;
  if (key.extension() == ".pack") key.replace_extension();
  key += ".key";
  return {pack, key};
}

}  // namespace touchtrial::design
