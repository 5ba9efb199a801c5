#include "stimuli/import/import_advice.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace touchtrial::stimuli {
namespace {

/// Three digits are enough for advice.
std::string rounded(double number) {
  std::array<char, 32> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.3g", number);
  return {text.data(), static_cast<std::size_t>(length)};
}

double median(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  const std::size_t middle = numbers.size() / 2;
  return numbers.size() % 2 == 1 ? numbers[middle] : (numbers[middle - 1] + numbers[middle]) / 2;
}

std::string scale_warning_of(const ImportedClass& one, const ImportOptions& options) {
  const double side_mm = options.size_px * options.pitch_mm;
  const std::string size =
      "class \"" + one.label + "\": features of about " + rounded(one.feature_mm) + " mm are ";
  if (one.feature_mm < kFinestFeatureMm) {
    return size +
           "finer than devices render well; give a larger --pitch-mm, or photographs from "
           "nearer";
  }
  if (one.feature_mm > side_mm / kFewestFeatures) {
    return size + "coarse for a picture of " + rounded(side_mm) +
           " mm, which will feel like a few slopes; give a smaller --pitch-mm, a larger --size, or "
           "photographs from farther away";
  }
  return {};
}

/// Said once for all photographs of a kind.
class Counted {
 public:
  void add(const std::string& name) {
    if (count_++ == 0) first_ = name;
  }
  [[nodiscard]] bool any() const { return count_ > 0; }
  [[nodiscard]] std::string text() const {
    return first_ + (count_ > 1 ? " and " + std::to_string(count_ - 1) + " more" : "");
  }

 private:
  int count_ = 0;
  std::string first_;
};

void add_resolution_warnings(const ImportRecord& record, const ImportOptions& options,
                             std::vector<std::string>& warnings) {
  Counted enlarged;
  Counted unused;
  double magnified = 0.0;
  for (const ImportedPhotograph& photograph : record.photographs) {
    const Photograph& photo = photograph.photo;
    if (photo.scale > 1.0) enlarged.add(photograph.file);
    const bool given = options.pixels_per_mm || options.pixels_per_mm_of_files;
    if (given || !photo.said_pixels_per_mm) continue;
    if (!unused.any()) magnified = *photo.said_pixels_per_mm * options.pitch_mm;
    unused.add(photograph.file);
  }
  if (enlarged.any()) {
    warnings.push_back(one_line(enlarged.text()) +
                       ": enlarged to the pitch; finer detail than the photograph has cannot come "
                       "back");
  }
  if (unused.any()) {
    warnings.push_back(one_line(unused.text()) +
                       ": the file says its resolution, by which it is "
                       "felt " +
                       rounded(magnified) +
                       " times as large as life; --pixels-per-mm "
                       "file makes it life-size");
  }
}

}  // namespace

ImportedClass class_figures(const SizedClass& one, const std::vector<int>& shares,
                            const ImportRecord& record, const ImportOptions& options) {
  ImportedClass figures;
  figures.label = one.label;
  figures.photographs = static_cast<int>(one.files.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    figures.crops += shares[i];
    figures.overlapping |= shares[i] > separate_crops(one.sizes[i], options.size_px);
  }
  std::vector<double> features_mm;
  for (const ImportedPicture& picture : record.pictures) {
    if (picture.label != one.label) continue;
    features_mm.push_back(picture.levels.feature_px * options.pitch_mm);
    figures.mean_grey += picture.levels.mean_grey / figures.crops;
    figures.rms_grey += picture.levels.rms_grey / figures.crops;
  }
  figures.feature_mm = median(std::move(features_mm));
  return figures;
}

std::vector<std::string> import_warnings(const std::vector<ImportedClass>& classes,
                                         const ImportRecord& record, const ImportOptions& options) {
  std::vector<std::string> warnings;
  add_resolution_warnings(record, options, warnings);
  for (const ImportedClass& one : classes) {
    if (one.overlapping) {
      warnings.push_back("class \"" + one.label +
                         "\": some crops share a part, up to half their side; larger or more "
                         "photographs give separate ones");
    }
    const std::string scale = scale_warning_of(one, options);
    if (!scale.empty()) warnings.push_back(scale);
  }
  constexpr double kNoticeableShare = 0.01;
  for (const ImportedPicture& picture : record.pictures) {
    if (picture.clipped_share <= kNoticeableShare) continue;
    warnings.push_back(picture.file + ": " + rounded(100 * picture.clipped_share) +
                       " % of its pixels were clipped by equalising; give --equalise both, or rms");
  }
  return warnings;
}

}  // namespace touchtrial::stimuli
