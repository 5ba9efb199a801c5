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

/// Devices do not render shorter waves well.
constexpr double kFinestFeatureMm = 1.0;
/// Fewer waves than this across a picture feel like slopes, not like a texture.
constexpr double kMinFeatures = 8.0;

[[noreturn]] void refuse(const std::string& what) {
  throw UsageError("stimuli import: " + what);
}

void check_numbers(const ImportOptions& options) {
  const auto outside = [](int number, int low, int high) { return number < low || number > high; };
  if (outside(options.size_px, kMinCropSizePx, kMaxCropSizePx)) {
    refuse("--size must be 16 to 4096, not " + std::to_string(options.size_px));
  }
  if (outside(options.crops, 1, kMaxCropsOfClass)) {
    refuse("--crops must be 1 to 1000, not " + std::to_string(options.crops));
  }
  if (!kPitchMm.contains(options.pitch_mm)) {
    refuse("--pitch-mm must be 0.001 to 10, not " + number_text(options.pitch_mm));
  }
  if (options.scale.bits != 0 && outside(options.scale.bits, 9, 16)) {
    refuse("--bits must be 9 to 16, not " + std::to_string(options.scale.bits));
  }
  const bool positive = !options.pixels_per_mm ||
                        (*options.pixels_per_mm > 0.0 && std::isfinite(*options.pixels_per_mm));
  if (!positive) refuse("--pixels-per-mm must be a number above 0, or the word file");
}

/// Whether `path` is `folder` or lies below it. Links are resolved as far as they exist.
bool is_within(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path inner = fs::weakly_canonical(fs::absolute(path), error);
  const fs::path outer = fs::weakly_canonical(fs::absolute(folder), error);
  const auto [end, unused] = std::ranges::mismatch(outer, inner);
  return end == outer.end() || (std::next(end) == outer.end() && end->empty());
}

void check_writable(const fs::path& path, const ImportOptions& options, const std::string& option) {
  std::error_code ignored;
  const fs::path above = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(above, ignored)) {
    refuse(one_line(above.string()) + " is not a folder; make it first, or give another " + option);
  }
  if (is_within(path, options.photographs) || is_within(options.photographs, path)) {
    refuse(one_line(path.string()) +
           " and the folder of photographs lie within one another; give another " + option);
  }
  refuse_link(path);
  if (!is_there(path) || options.replace) return;
  refuse(
      one_line(path.string()) + " exists already; give another " + option +
      ", or --force, which replaces what an earlier import wrote and keeps everything else under "
      "another name");
}

void check_places(const ImportOptions& options) {
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

std::string times(int side_px) {
  return std::to_string(side_px) + " x " + std::to_string(side_px) + " pixels";
}

bool all_fit(const std::vector<SizedClass>& classes, int side_px, int crops) {
  return std::ranges::all_of(classes, [&](const SizedClass& one) {
    return !crop_shares(one.sizes, side_px, crops).empty();
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

/// The classes that one warning is about, and the sizes of their features.
struct ClassesAlike {
  std::vector<std::string> labels;
  std::vector<double> features_mm;

  void add(const ImportedClass& one) {
    labels.push_back(in_quotes(one.label));
    features_mm.push_back(one.feature_mm);
  }
  [[nodiscard]] std::string named() const { return "class " + first_of(labels) + ": "; }
  [[nodiscard]] std::string features() const {
    const auto [min, max] = std::ranges::minmax(features_mm);
    const std::string range = rounded(min) == rounded(max) ? "" : " to " + rounded(max);
    return "features of about " + rounded(min) + range + " mm are ";
  }
};

void add_class_warnings(const std::vector<ImportedClass>& classes, const ImportOptions& options,
                        std::vector<std::string>& warnings) {
  const double side_mm = options.size_px * options.pitch_mm;
  ClassesAlike overlapping;
  ClassesAlike fine;
  ClassesAlike coarse;
  for (const ImportedClass& one : classes) {
    if (one.overlapping) overlapping.add(one);
    if (one.feature_mm < kFinestFeatureMm) {
      fine.add(one);
    } else if (one.feature_mm > side_mm / kMinFeatures) {
      coarse.add(one);
    }
  }
  if (!overlapping.labels.empty()) {
    warnings.push_back(overlapping.named() +
                       "some crops overlap, by up to half their side; larger or more photographs "
                       "give separate crops");
  }
  if (!fine.labels.empty()) {
    warnings.push_back(fine.named() + fine.features() +
                       "finer than devices render well; give `touchtrial stimuli import` a larger "
                       "--pitch-mm, or photographs from closer up");
  }
  if (!coarse.labels.empty()) {
    warnings.push_back(coarse.named() + coarse.features() + "coarse for a picture of " +
                       rounded(side_mm) +
                       " mm, which will feel like a few slopes; give a larger --size, `touchtrial "
                       "stimuli import` a smaller --pitch-mm, or photographs from farther away");
  }
}

void add_resolution_warnings(const ImportRecord& record, const ImportOptions& options,
                             std::vector<std::string>& warnings) {
  const bool is_given = options.pixels_per_mm || options.pixels_per_mm_of_files;
  std::vector<std::string> enlarged;
  std::vector<std::string> of_camera;
  std::vector<std::string> unused;
  double magnified = 0.0;
  for (const ImportedPhotograph& photograph : record.photographs) {
    const Photograph& photo = photograph.photo;
    if (photo.scale > 1.0) enlarged.push_back(photograph.file);
    if (!is_given && photo.notes.camera_dpi) of_camera.push_back(photograph.file);
    if (is_given || !photo.notes.pixels_per_mm) continue;
    if (unused.empty()) magnified = *photo.notes.pixels_per_mm * options.pitch_mm;
    unused.push_back(photograph.file);
  }
  if (!enlarged.empty()) {
    warnings.push_back(first_of(enlarged) +
                       ": enlarged to the pitch, which adds no detail; give photographs of more "
                       "pixels, or a larger --pitch-mm");
  }
  if (!of_camera.empty()) {
    warnings.push_back(first_of(of_camera) +
                       ": the resolution in the file is a camera's default, unrelated to the "
                       "object; for life-size, photograph a ruler, and give `touchtrial stimuli "
                       "import` --pixels-per-mm");
  }
  if (!unused.empty()) {
    warnings.push_back(
        first_of(unused) +
        ": the file states its resolution; if that is of the object, as a "
        "scanner's is, the crops feel " +
        rounded(magnified) +
        " times life-size; for life-size, give `touchtrial stimuli import` --pixels-per-mm file");
  }
}

/// Photographs are turned upright, and crops do not lie where one is transparent.
std::vector<std::string> remarks_of(const Photograph& photo) {
  engine::ImageNotes notes = photo.notes;
  notes.orientation = 1;
  notes.transparent_share = 0.0;
  std::vector<std::string> remarks = engine::remarks_on(notes);
  if (photo.opaque) {
    remarks.push_back("is transparent in places; crops come from its opaque " +
                      std::to_string(photo.opaque->size_px.width_px) + " x " +
                      std::to_string(photo.opaque->size_px.height_px) + " pixels at x " +
                      std::to_string(photo.opaque->x) + ", y " + std::to_string(photo.opaque->y) +
                      "; for crops from elsewhere, fill its background, and export it again");
  }
  return remarks;
}

}  // namespace

void check_import(const ImportOptions& options) {
  check_numbers(options);
  check_places(options);
}

void check_classes(const PhotoFolder& folder, const ImportOptions& options) {
  const std::size_t classes = folder.classes.size();
  const std::string name = one_line(options.photographs.string());
  if (classes < 2) {
    throw FileError(name + ": holds 1 class, \"" + folder.classes.front().label +
                    "\"; a study needs 2 or more: add a folder or a photograph of another");
  }
  if (classes > kMaxClasses) {
    throw FileError(name + ": holds " + std::to_string(classes) + " classes, more than " +
                    std::to_string(kMaxClasses) +
                    "; to make several photographs one class, put them into a folder of its name, "
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
         (photo.opaque ? " where it is opaque (or fill its background)" : "") +
         (photo.scale != 1.0 ? " after resampling" : "") + ", too few for a crop of " +
         times(options.size_px);
}

std::vector<std::vector<int>> plan_shares(const std::vector<SizedClass>& classes,
                                          std::vector<std::string> small,
                                          const ImportOptions& options) {
  if (!small.empty()) refuse_crops(std::move(small), classes, options);
  std::vector<std::vector<int>> shares;
  std::vector<std::string> faults;
  for (const SizedClass& one : classes) {
    shares.push_back(crop_shares(one.sizes, options.size_px, options.crops));
    if (!shares.back().empty()) continue;
    const int room = std::accumulate(
        one.sizes.begin(), one.sizes.end(), 0,
        [&](int sum, PhotoSize size) { return sum + overlapping_crops(size, options.size_px); });
    faults.push_back(one_line(options.photographs.string()) + ": class \"" + one.label + "\" has " +
                     counted(static_cast<std::int64_t>(one.files.size()), "photograph") +
                     ", with room for " + counted(room, "crop") + " of " + times(options.size_px) +
                     " that share at most half their side, not " + std::to_string(options.crops));
  }
  if (!faults.empty()) refuse_crops(std::move(faults), classes, options);
  return shares;
}

ImportedClass summary_of(const SizedClass& one, const std::vector<int>& shares,
                         const ImportRecord& record, const ImportOptions& options) {
  ImportedClass summary;
  summary.label = one.label;
  summary.photographs = static_cast<int>(one.files.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    summary.crops += shares[i];
    summary.overlapping |= shares[i] > separate_crops(one.sizes[i], options.size_px);
  }
  std::vector<double> features_mm;
  for (const ImportedPicture& picture : record.pictures) {
    if (picture.label != one.label) continue;
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
    warnings.push_back(first_of(report.ignored) +
                       ": ignored, as it neither begins nor ends like a picture; convert it to "
                       "PNG if it is one");
  }
  for (const ImportedPhotograph& photograph : record.photographs) {
    for (const std::string& remark : remarks_of(photograph.photo)) {
      warnings.push_back(one_line(photograph.file + ": " + remark));
    }
  }
  std::vector<std::string> labels;
  for (const ImportedClass& one : report.classes) labels.push_back(one.label);
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
