#include "stimuli/import/import_files.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/named.hpp"
#include "core/version.hpp"
#include "stimuli/default_set.hpp"

#include <array>

#include <nlohmann/json.hpp>

namespace touchtrial::stimuli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kImportVersion = 1;

const char* name_of(LevelEqualising equalising) {
  using enum LevelEqualising;
  static constexpr auto kNames = std::to_array<Named<LevelEqualising>>(
      {{"none", none}, {"mean", mean}, {"rms", rms}, {"both", both}});
  return name_in(kNames, equalising).data();
}

Json or_null(const std::optional<double>& number) {
  return number ? Json(*number) : Json();
}

Json or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

Json part_json(const PhotoPart& part) {
  return {{"x", part.x},
          {"y", part.y},
          {"width", part.size_px.width_px},
          {"height", part.size_px.height_px}};
}

Json to_json(const ImportedPhotograph& photograph) {
  const Photograph& photo = photograph.photo;
  return {{"file", photograph.file},
          {"sha256", to_hex(photo.sha256)},
          {"pixels_sha256", to_hex(photo.pixels_sha256)},
          {"width_px", photo.width_px},
          {"height_px", photo.height_px},
          {"orientation", photo.notes.orientation},
          {"pixels_per_mm", or_null(photo.notes.pixels_per_mm)},
          {"camera_dpi", or_null(photo.notes.camera_dpi)},
          {"pictures", photo.notes.pictures},
          {"transparent_share", photo.notes.transparent_share},
          {"opaque", photo.opaque_rectangle ? part_json(*photo.opaque_rectangle) : Json()},
          {"lacks_end", photo.notes.lacks_end},
          {"cut_share", photo.notes.cut_share},
          {"heights", photo.notes.heights
                          ? Json::array({photo.notes.heights->first, photo.notes.heights->second})
                          : Json()},
          {"scale", photo.scale}};
}

Json to_json(const ImportedPicture& picture, const ImportRecord& record,
             const ImportOptions& options) {
  return {{"label", picture.label},
          {"file", picture.file},
          {"photograph", record.photographs[picture.photograph].file},
          {"crop",
           part_json({picture.position.x, picture.position.y, {options.size_px, options.size_px}})},
          {"mean_grey", picture.levels.mean_grey},
          {"rms_grey", picture.levels.rms_grey},
          {"feature_mm", picture.levels.feature_px * options.pitch_mm},
          {"clipped_share", picture.clipped_share},
          {"sha256", to_hex(picture.sha256)},
          {"pixels_sha256", to_hex(picture.pixels_sha256)}};
}

/// The seed of the participants' schedules, which depends on the pictures.
std::uint64_t study_seed(const ImportRecord& record, std::uint64_t seed) {
  FieldHasher hasher;
  hasher.add("touchtrial import seed").add(static_cast<std::int64_t>(seed));
  for (const ImportedPicture& picture : record.pictures) {
    hasher.add(picture.label).add(ByteView(picture.pixels_sha256));
  }
  std::uint64_t number = 0;
  const Digest digest = hasher.finish();
  for (std::size_t i = 0; i < 6; ++i) number = number << 8U | digest[i];
  return number + 1;  // 0 means not set
}

Json methods_of(const ImportOptions& options) {
  Json methods = Json::array({{{"name", "adaptive"}, {"radius", 2}}});
  if (options.methods > 1) {
    methods.push_back({{"name", "tv-gabor"}, {"lambda", 0.01}});
  }
  return methods;
}

Json rendering_of(const ImportOptions& options) {
  const bool has_two_methods = options.methods > 1;
  return {{"model", "paper"},
          {"pitch_mm", options.pitch_mm},
          {"gains", "budget"},
          // Otherwise strength would distinguish the methods.
          {"equalise", has_two_methods ? "rms" : "none"}};
}

Json classes_of(const ImportRecord& record, const std::filesystem::path& folder) {
  Json classes = Json::array();
  for (const ImportedPicture& picture : record.pictures) {
    if (classes.empty() || classes.back().at("label") != picture.label) {
      classes.push_back({{"label", picture.label}, {"images", Json::array()}});
    }
    classes.back()["images"].push_back((folder / picture.file).generic_string());
  }
  return classes;
}

}  // namespace

std::string manifest_text(const ImportRecord& record, const ImportOptions& options,
                          const std::vector<std::string>& remarks) {
  Json json = {{"format", kImportFormat},
               {"version", kImportVersion},
               {"program_version", program_version()},
               {"licence", or_null(options.licence)},
               {"source", or_null(options.source)},
               {"seed", options.seed},
               {"size_px", options.size_px},
               {"crops", options.crops},
               {"pitch_mm", options.pitch_mm},
               {"pixels_per_mm", or_null(options.pixels_per_mm)},
               {"equalise", name_of(options.equalise)},
               {"equal_mean_grey", or_null(record.target_levels.mean_grey)},
               {"equal_rms_grey", or_null(record.target_levels.rms_grey)},
               {"remarks", remarks},
               {"photographs", Json::array()},
               {"pictures", Json::array()}};
  if (options.pixels_per_mm_of_files) json["pixels_per_mm"] = "file";
  for (const auto& photograph : record.photographs) {
    json["photographs"].push_back(to_json(photograph));
  }
  for (const auto& picture : record.pictures) {
    json["pictures"].push_back(to_json(picture, record, options));
  }
  return json.dump(2) + "\n";
}

std::string study_file_text(const ImportRecord& record, const ImportOptions& options,
                            const std::string& name, const std::filesystem::path& folder) {
  const Json study = {{"study", name},
                      {"protocol", options.protocol},
                      {"classes", classes_of(record, folder)},
                      {"methods", methods_of(options)},
                      {"rendering", rendering_of(options)},
                      {"trials", {{"repeats", 5}, {"order", "shuffled"}, {"explore_limit_s", 60}}},
                      {"blinding", "double"},
                      {"seed", study_seed(record, options.seed)}};
  return study.dump(2) + "\n";
}

}  // namespace touchtrial::stimuli
