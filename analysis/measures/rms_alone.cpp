#include "analysis/measures/rms_alone.hpp"

#include "engine/rendering/field_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::analysis {
namespace {

struct Sum {
  double total = 0.0;
  double count = 0.0;

  void add(double value) {
    total += value;
    count += 1.0;
  }
  [[nodiscard]] double mean_without(const Sum& part) const {
    return (total - part.total) / (count - part.count);
  }
};

Sum sum_of(const PatchStrengths& picture) {
  Sum sum;
  for (const double strength : picture.log_rms) sum.add(strength);
  return sum;
}

class Strengths {
 public:
  explicit Strengths(std::span<const PatchStrengths> pictures) : pictures_(pictures) {
    for (const PatchStrengths& picture : pictures) {
      if (picture.label < 0) throw std::invalid_argument("rms_alone: a label is negative");
      const auto label = static_cast<std::size_t>(picture.label);
      if (label >= classes_.size()) {
        classes_.resize(label + 1);
        pictures_of_class_.resize(label + 1, 0);
      }
      const Sum sum = sum_of(picture);
      classes_[label].total += sum.total;
      classes_[label].count += sum.count;
      ++pictures_of_class_[label];
    }
    for (const Sum& sum : classes_) {
      if (sum.count < 2.0) throw std::invalid_argument("rms_alone: a class has too few patches");
    }
  }

  [[nodiscard]] int classes() const { return static_cast<int>(classes_.size()); }
  [[nodiscard]] bool has_other_pictures() const {
    return std::ranges::all_of(pictures_of_class_, [](int count) { return count >= 2; });
  }

  /// The mean over the set's classes of the share of patches with the right answer.
  [[nodiscard]] double right_share(std::span<const int> set, bool picture_unseen) const {
    std::vector<Sum> right(classes_.size());
    for (const PatchStrengths& picture : pictures_) {
      if (std::ranges::find(set, picture.label) == set.end()) continue;
      const Sum whole = sum_of(picture);
      for (const double strength : picture.log_rms) {
        const Sum hidden = picture_unseen ? whole : Sum{strength, 1.0};
        const int answer = nearest(set, strength, picture.label, hidden);
        right[static_cast<std::size_t>(picture.label)].add(answer == picture.label ? 1.0 : 0.0);
      }
    }
    double sum = 0.0;
    for (const int label : set) sum += right[static_cast<std::size_t>(label)].mean_without({});
    return sum / static_cast<double>(set.size());
  }

 private:
  [[nodiscard]] int nearest(std::span<const int> set, double strength, int own,
                            const Sum& hidden) const {
    return *std::ranges::min_element(set, {}, [&](int label) {
      const Sum& sum = classes_[static_cast<std::size_t>(label)];
      return std::abs(sum.mean_without(label == own ? hidden : Sum{}) - strength);
    });
  }

  std::span<const PatchStrengths> pictures_;
  std::vector<Sum> classes_;
  std::vector<int> pictures_of_class_;
};

/// Moves to the next set of ascending numbers below `limit`, in lexical order.
/// \return whether there is one
bool advance(std::vector<int>& set, int limit) {
  const auto size = static_cast<int>(set.size());
  int place = size - 1;
  while (place >= 0 && set[place] == limit - size + place) --place;
  if (place < 0) return false;
  ++set[place];
  for (int i = place + 1; i < size; ++i) set[i] = set[i - 1] + 1;
  return true;
}

}  // namespace

std::vector<double> patch_strengths(engine::FieldView field, double tangential_n,
                                    double threshold_n) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  if (std::min(height, width) < kPatchesASide) {
    throw std::invalid_argument("patch_strengths: the field is too small");
  }
  const engine::ForceField<double> force = engine::lateral_field(field, {}).force;
  std::vector<Sum> squares(static_cast<std::size_t>(kPatchesASide * kPatchesASide));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int row = std::min(y / (height / kPatchesASide), kPatchesASide - 1);
      const int column = std::min(x / (width / kPatchesASide), kPatchesASide - 1);
      const double fx = tangential_n * force.x.at(y, x);
      const double fy = tangential_n * force.y.at(y, x);
      squares[static_cast<std::size_t>(row * kPatchesASide + column)].add(fx * fx + fy * fy);
    }
  }
  std::vector<double> strengths;
  for (const Sum& sum : squares) {
    strengths.push_back(0.5 * std::log(sum.mean_without({}) + threshold_n * threshold_n));
  }
  return strengths;
}

RmsAlone rms_alone(std::span<const PatchStrengths> pictures, int classes_in_set) {
  const Strengths strengths(pictures);
  if (classes_in_set < 2 || classes_in_set > strengths.classes()) {
    throw std::invalid_argument(
        "rms_alone: a set must have 2 classes or more, and no more than there are");
  }
  RmsAlone result;
  result.classes = classes_in_set;
  std::vector<int> set(static_cast<std::size_t>(classes_in_set));
  for (int i = 0; i < classes_in_set; ++i) set[i] = i;
  double patch = 0.0;
  double picture = 0.0;
  const bool others = strengths.has_other_pictures();
  do {
    ++result.sets;
    patch += strengths.right_share(set, false);
    if (others) picture += strengths.right_share(set, true);
  } while (advance(set, strengths.classes()));
  result.unseen_patch = patch / result.sets;
  if (others) result.unseen_picture = picture / result.sets;
  return result;
}

}  // namespace touchtrial::analysis
