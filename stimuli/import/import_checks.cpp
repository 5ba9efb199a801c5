#include "stimuli/import/import_checks.hpp"

#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/labels.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <system_error>
#include <utility>

namespace touchtrial::stimuli {
namespace {

namespace fs = std::filesystem;
using engine::rounded;

// The limits of study files.
constexpr std::size_t kMaxClasses = 64;
constexpr int kMaxStimuli = 10'000;
constexpr NumberRange kPitchMm{0.001, 10.0};

/// The shortest wavelength that devices render well.
constexpr double kFinestFeatureMm = 1.0;
/// With fewer waves across a picture, features feel like slopes rather than texture.
constexpr double kMinFeatures = 8.0;

[[noreturn]] void refuse(const std::string& problem) {
  throw UsageError("stimuli import: " + problem);
}

void check_numbers(const ImportOptions& options) {
  const auto is_outside = [](int number, int low, int high) {
    return number < low || number > high;
  };
  if (is_outside(options.size_px, kMinCropSizePx, kMaxCropSizePx)) {
    refuse("--size must be 16 to 4096, not " + std::to_string(options.size_px));
  }
  if (is_outside(options.crops, 1, kMaxCropsOfClass)) {
    refuse("--crops must be 1 to 1000, not " + std::to_string(options.crops));
  }
  if (!kPitchMm.contains(options.pitch_mm)) {
    refuse("--pitch-mm must be 0.001 to 10, not " + number_text(options.pitch_mm));
  }
  if (options.scale.bits != 0 && is_outside(options.scale.bits, 9, 16)) {
    refuse("--bits must be 9 to 16, not " + std::to_string(options.scale.bits));
  }
  const bool is_positive = !options.pixels_per_mm ||
                           (*options.pixels_per_mm > 0.0 && std::isfinite(*options.pixels_per_mm));
  if (!is_positive) refuse("--pixels-per-mm must be a number above 0, or the word file");
}

/// Whether `path` is `folder` or inside it. Resolves links of existing parts.
bool is_within(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path inner = fs::weakly_canonical(fs::absolute(path), error);
  const fs::path outer = fs::weakly_canonical(fs::absolute(folder), error);
  const auto [end, unused] = std::ranges::mismatch(outer, inner);
  return end == outer.end() || (std::next(end) == outer.end() && end->empty());
}

void check_writable(const fs::path& path, const ImportOptions& options, const std::string& option) {
  std::error_code ignored;
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(parent, ignored)) {
    refuse(one_line(parent.string()) + " is not a folder; create it first, or give another " +
           option);
  }
  if (is_within(path, options.photographs) || is_within(options.photographs, path)) {
    refuse(one_line(path.string()) +
           " and the folder of photographs must not contain each other; give another " + option);
  }
  refuse_link(path);
  if (!path_exists(path) || options.replace) return;
  refuse(
      one_line(path.string()) + " already exists; give another " + option +
      ", or --force, which replaces what an earlier import wrote and keeps everything else under "
      "another name");
}

void check_paths(const ImportOptions& options) {
  if (options.study.extension() != ".json" || options.study.stem().empty()) {
    refuse("the study file must end in .json, not be " +
           in_quotes(options.study.filename().string()) + "; give another --study");
  }
  for (const std::string& text :
       {options.study.string(), options.pictures.string(), options.licence, options.source}) {
    if (!is_utf8(text)) {
      refuse("a path or text is not UTF-8 and cannot go into a JSON file; write it in UTF-8");
    }
  }
  check_writable(options.study, options, "--study");
  check_writable(options.pictures, options, "--out");
  std::error_code ignored;
  if (fs::is_directory(options.study, ignored)) {
    refuse(one_line(options.study.string()) + " is a folder; give another --study");
  }
}

std::string dimensions(int side_px) {
  return std::to_string(side_px) + " x " + std::to_string(side_px) + " pixels";
}

bool all_fit(const std::vector<SizedClass>& classes, int side_px, int crops) {
  return std::ranges::all_of(classes, [&](const SizedClass& photo_class) {
    return !distribute_crops(photo_class.sizes, side_px, crops).empty();
  });
}

/// Refuses with the remedy in numbers: fewer crops of this size, or smaller crops.
[[noreturn]] void refuse_crops(std::vector<std::string> faults,
                               const std::vector<SizedClass>& classes,
                               const ImportOptions& options) {
  int crops = options.crops;
  while (crops > 0 && !all_fit(classes, options.size_px, crops)) --crops;
  int side_px = options.size_px;
  while (side_px >= kMinCropSizePx && !all_fit(classes, side_px, options.crops)) --side_px;
  std::string remedy = "give ";
  if (crops > 0) remedy += "--crops " + std::to_string(crops) + ", ";
  if (side_px >= kMinCropSizePx) remedy += "--size " + std::to_string(side_px) + ", ";
  remedy += "or more or larger photographs";
  for (std::string& fault : faults) fault += "; " + remedy;
  throw CropsDoNotFit(options.photographs, std::move(faults), remedy, crops,
                      side_px >= kMinCropSizePx ? side_px : 0);
}

/// The classes that one warning names, and their feature sizes.
struct WarningClasses {
  std::vector<std::string> labels;
  std::vector<double> features_mm;

  void add(const ImportedClass& photo_class) {
    labels.push_back(in_quotes(photo_class.label));
    features_mm.push_back(photo_class.feature_mm);
  }
  [[nodiscard]] std::string prefix() const { return "class " + first_and_count(labels) + ": "; }
  [[nodiscard]] std::string features() const {
    const auto [min, max] = std::ranges::minmax(features_mm);
    const std::string range = rounded(min) == rounded(max) ? "" : " to " + rounded(max);
    return "features of about " + rounded(min) + range + " mm are ";
  }
};

void add_class_warnings(const std::vector<ImportedClass>& classes, const ImportOptions& options,
                        std::vector<std::string>& warnings) {
  const double side_mm = options.size_px * options.pitch_mm;
  WarningClasses overlapping_classes;
  WarningClasses fine_classes;
  WarningClasses coarse_classes;
  for (const ImportedClass& photo_class : classes) {
    if (photo_class.overlapping) overlapping_classes.add(photo_class);
    if (photo_class.feature_mm < kFinestFeatureMm) {
      fine_classes.add(photo_class);
    } else if (photo_class.feature_mm > side_mm / kMinFeatures) {
      coarse_classes.add(photo_class);
    }
  }
  if (!overlapping_classes.labels.empty()) {
    warnings.push_back(overlapping_classes.prefix() +
                       "some crops overlap, by up to half their side; larger or more photographs "
                       "give separate crops");
  }
  if (!fine_classes.labels.empty()) {
    warnings.push_back(fine_classes.prefix() + fine_classes.features() +
                       "finer than devices render well; give `touchtrial stimuli import` a larger "
                       "--pitch-mm, or photographs from closer up");
  }
  if (!coarse_classes.labels.empty()) {
    warnings.push_back(coarse_classes.prefix() + coarse_classes.features() +
                       "coarse for a picture of " + rounded(side_mm) +
                       " mm, which will feel like a few slopes; give a larger --size, `touchtrial "
                       "stimuli import` a smaller --pitch-mm, or photographs from farther away");
  }
}

void add_resolution_warnings(const ImportRecord& record, const ImportOptions& options,
                             std::vector<std::string>& warnings) {
  const bool has_resolution_option = options.pixels_per_mm || options.pixels_per_mm_of_files;
  std::vector<std::string> enlarged_files;
  std::vector<std::string> camera_dpi_files;
  std::vector<std::string> unused_resolution_files;
  double magnification = 0.0;
  for (const ImportedPhotograph& photograph : record.photographs) {
    const Photograph& photo = photograph.photo;
    if (photo.scale > 1.0) enlarged_files.push_back(photograph.file);
    if (!has_resolution_option && photo.notes.camera_dpi)
      camera_dpi_files.push_back(photograph.file);
    if (has_resolution_option || !photo.notes.pixels_per_mm) continue;
    if (unused_resolution_files.empty())
      magnification = *photo.notes.pixels_per_mm * options.pitch_mm;
    unused_resolution_files.push_back(photograph.file);
  }
  if (!enlarged_files.empty()) {
    warnings.push_back(first_and_count(enlarged_files) +
                       ": enlarged to the pitch, which adds no detail; give photographs of more "
                       "pixels, or a larger --pitch-mm");
  }
  if (!camera_dpi_files.empty()) {
    warnings.push_back(first_and_count(camera_dpi_files) +
                       ": the resolution in the file is a camera's default, unrelated to the "
                       "object; for life-size, photograph a ruler, and give `touchtrial stimuli "
                       "import` --pixels-per-mm");
  }
  if (!unused_resolution_files.empty()) {
    warnings.push_back(
        first_and_count(unused_resolution_files) +
        ": the file states its resolution; if it refers to the object, as from a scanner, the "
        "crops "
        "feel " +
        rounded(magnification) +
        " times life-size; for life-size, give `touchtrial stimuli import` --pixels-per-mm file");
  }
}

/// The remarks except for orientation and transparency, which the import handles.
std::vector<std::string> remarks_of(const Photograph& photo) {
  engine::ImageNotes notes = photo.notes;
  notes.orientation = 1;
  notes.transparent_share = 0.0;
  std::vector<std::string> remarks = engine::remarks_on(notes);
  if (photo.opaque_rectangle) {
    remarks.push_back("is partly transparent; crops are taken from its opaque " +
                      std::to_string(photo.opaque_rectangle->size_px.width_px) + " x " +
                      std::to_string(photo.opaque_rectangle->size_px.height_px) + " pixels at x " +
                      std::to_string(photo.opaque_rectangle->x) + ", y " +
                      std::to_string(photo.opaque_rectangle->y) +
                      "; for other crops, fill its background and export it again");
  }
  return remarks;
}

}  // namespace

void check_import(const ImportOptions& options) {
  check_numbers(options);
  check_paths(options);
}

void check_classes(const PhotoFolder& folder, const ImportOptions& options) {
  const std::size_t classes = folder.classes.size();
  const std::string name = one_line(options.photographs.string());
  if (classes < 2) {
    throw FileError(name + ": contains 1 class, \"" + folder.classes.front().label +
                    "\"; a study needs 2 or more: add a folder or a photograph of another class");
  }
  if (classes > kMaxClasses) {
    throw FileError(name + ": contains " + std::to_string(classes) + " classes, more than " +
                    std::to_string(kMaxClasses) +
                    "; to combine photographs into one class, put them into a folder of its name, "
                    "or give `touchtrial stimuli import` --names");
  }
  if (static_cast<int>(classes) * options.crops * options.methods > kMaxStimuli) {
    throw FileError(name + ": " + std::to_string(classes) + " classes of " +
                    std::to_string(options.crops) + " crops make more than " +
                    std::to_string(kMaxStimuli) + " stimuli; give fewer --crops");
  }
}

std::string fault_of_size(const Photograph& photo, PhotoSize size, const ImportOptions& options) {
  if (std::min(size.height_px, size.width_px) >= options.size_px) return {};
  return one_line(photo.path.string()) + ": has " + std::to_string(size.width_px) + " x " +
         std::to_string(size.height_px) + " pixels" +
         (photo.opaque_rectangle ? " where it is opaque (or fill its background)" : "") +
         (photo.scale != 1.0 ? " after resampling" : "") + ", too few for a crop of " +
         dimensions(options.size_px);
}

std::vector<std::vector<int>> plan_crops(const std::vector<SizedClass>& classes,
                                         std::vector<std::string> size_faults,
                                         const ImportOptions& options) {
  if (!size_faults.empty()) refuse_crops(std::move(size_faults), classes, options);
  std::vector<std::vector<int>> crop_counts;
  std::vector<std::string> faults;
  for (const SizedClass& photo_class : classes) {
    crop_counts.push_back(distribute_crops(photo_class.sizes, options.size_px, options.crops));
    if (!crop_counts.back().empty()) continue;
    const int room = std::accumulate(
        photo_class.sizes.begin(), photo_class.sizes.end(), 0,
        [&](int sum, PhotoSize size) { return sum + overlapping_crops(size, options.size_px); });
    faults.push_back(
        one_line(options.photographs.string()) + ": class \"" + photo_class.label + "\" has " +
        counted(static_cast<std::int64_t>(photo_class.files.size()), "photograph") +
        ", with room for " + counted(room, "crop") + " of " + dimensions(options.size_px) +
        " that overlap by at most half their side, not " + std::to_string(options.crops));
  }
  if (!faults.empty()) refuse_crops(std::move(faults), classes, options);
  return crop_counts;
}

ImportedClass summary_of(const SizedClass& photo_class, const std::vector<int>& crop_counts,
                         const ImportRecord& record, const ImportOptions& options) {
  ImportedClass summary;
  summary.label = photo_class.label;
  summary.photographs = static_cast<int>(photo_class.files.size());
  for (std::size_t i = 0; i < crop_counts.size(); ++i) {
    summary.crops += crop_counts[i];
    summary.overlapping |= crop_counts[i] > separate_crops(photo_class.sizes[i], options.size_px);
  }
  std::vector<double> features_mm;
  for (const ImportedPicture& picture : record.pictures) {
    if (picture.label != photo_class.label) continue;
    features_mm.push_back(picture.levels.feature_px * options.pitch_mm);
    summary.mean_grey += picture.levels.mean_grey / summary.crops;
    summary.rms_grey += picture.levels.rms_grey / summary.crops;
  }
  summary.feature_mm = median(std::move(features_mm));
  return summary;
}

std::vector<std::string> import_warnings(const ImportReport& report, const ImportRecord& record,
                                         const ImportOptions& options) {
  std::vector<std::string> warnings;
  if (!report.ignored.empty()) {
    warnings.push_back(first_and_count(report.ignored) +
                       ": ignored, because it has neither the content nor the extension of a "
                       "picture; convert it to "
                       "PNG if it is one");
  }
  for (const ImportedPhotograph& photograph : record.photographs) {
    for (const std::string& remark : remarks_of(photograph.photo)) {
      warnings.push_back(one_line(photograph.file + ": " + remark));
    }
  }
  std::vector<std::string> labels;
  for (const ImportedClass& photo_class : report.classes) labels.push_back(photo_class.label);
  if (auto remark = remark_on_alphabets(labels); !remark.empty()) {
    warnings.push_back(std::move(remark));
  }
  add_resolution_warnings(record, options, warnings);
  add_class_warnings(report.classes, options, warnings);
  constexpr double kNoticeableShare = 0.01;
  for (const ImportedPicture& picture : record.pictures) {
    if (picture.clipped_share <= kNoticeableShare) continue;
    warnings.push_back(picture.file + ": " + rounded(100 * picture.clipped_share) +
                       " % of its pixels were clipped by equalising; give --equalise both, or rms");
  }
  return warnings;
}

}  // namespace touchtrial::stimuli
