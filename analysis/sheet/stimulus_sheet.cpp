#include "analysis/sheet/stimulus_sheet.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "engine/image_file.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "protocols/design/stimulus_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr engine::Rgb kFrameColour{230, 60, 0};

/// A method with its main option.
std::string options_in_words(const engine::ExtractionOptions& method) {
  const std::string name(name_of(method.method));
  switch (method.method) {
    case engine::Method::adaptive:
      return fmt::format("{}, radius {}", name, method.radius);
    case engine::Method::fixed:
      return fmt::format("{}, order {:g}", name, method.order);
    case engine::Method::tv_gabor:
      return fmt::format("{}, lambda {:g}", name, method.tv_gabor.lambda);
    case engine::Method::gaussian:
      return fmt::format("{}, sigma {:g} px", name, method.sigma_px);
    case engine::Method::median:
      return fmt::format("{}, radius {}", name, method.radius);
    case engine::Method::edge:
      return fmt::format("{}, divisor {:g}", name, method.divisor);
    case engine::Method::luminance:
      return name;
  }
  return name;
}

std::string in_words(const design::StudyMethod& method) {
  const std::string words = options_in_words(method) +
                            (method.control == engine::Control::none ? "" : ", phase-scrambled");
  return method.label == design::default_label(method) ? words
                                                       : one_line(method.label) + ": " + words;
}

std::string in_words(const engine::RenderingOptions& rendering) {
  const std::string_view model = design::name_of(rendering.model);
  return fmt::format("model {}, {:g} mm a pixel, filter {:g} mm, wall {:g} N/mm, gains {}{}{}",
                     model, rendering.pitch_mm, rendering.filter_mm, rendering.stiffness_n_per_mm,
                     rendering.gains ? "explicit"
                                     : fmt::format("from a budget of {:g} N/mm",
                                                   rendering.texture_stiffness_n_per_mm),
                     rendering.equalise == engine::Equalise::rms ? ", rms force equalised" : "",
                     rendering.touchdown_ramp_n == 0.0
                         ? ""
                         : fmt::format(", touchdown ramp {:g} N", rendering.touchdown_ramp_n));
}

/// The patch of the strongest force, small enough to show arrows.
engine::ArrowPatch shown_patch(const engine::ForceField<double>& force) {
  constexpr int kSide_px = 16;
  engine::ArrowPatch patch = engine::strongest_patch(force);
  patch.y += std::max(0, patch.height - kSide_px) / 2;
  patch.x += std::max(0, patch.width - kSide_px) / 2;
  patch.height = std::min(patch.height, kSide_px);
  patch.width = std::min(patch.width, kSide_px);
  return patch;
}

/// The texture with its contrast enlarged, equally for all stimuli.
GreyImage enhanced_picture(Plane<float> texture) {
  constexpr float kContrast = 3.0F;
  for (float& grey : texture.samples()) grey *= kContrast;
  return engine::texture_picture(texture);
}

/// The width of an image's pixel in pixels of the sheet.
double fitting_scale(int height, int width, int side_px) {
  return static_cast<double>(side_px) / std::max(height, width);
}

GreyImage fitted(const GreyImage& image, int side_px) {
  const double scale = fitting_scale(image.height(), image.width(), side_px);
  return engine::resized(image, std::max(1, static_cast<int>(std::lround(image.height() * scale))),
                         std::max(1, static_cast<int>(std::lround(image.width() * scale))));
}

/// In colour, with a frame just outside the patch.
engine::ColourImage framed(const GreyImage& picture, const engine::ArrowPatch& patch,
                           double scale) {
  constexpr int kLine_px = 3;
  const auto at = [scale](int place) { return static_cast<int>(std::lround(place * scale)); };
  const int left = at(patch.x);
  const int top = at(patch.y);
  const int right = at(patch.x + patch.width);
  const int bottom = at(patch.y + patch.height);
  const auto within = [&](int y, int x, int margin) {
    return x >= left - margin && x < right + margin && y >= top - margin && y < bottom + margin;
  };
  engine::ColourImage image(picture.height(), picture.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const std::uint8_t grey = picture.at(y, x);
      const bool on_frame = within(y, x, kLine_px) && !within(y, x, 0);
      image.at(y, x) = on_frame ? kFrameColour : engine::Rgb{grey, grey, grey};
    }
  }
  return image;
}

[[noreturn]] void refuse(const engine::Pack& pack, const std::string& what) {
  throw VerificationError(one_line(pack.folder().string()) + ": " + what +
                          "; run touchtrial prepare, then make the sheet again");
}

/// Makes the cards of one pack.
class Cards {
 public:
  Cards(const design::StudyKey& key, const engine::Pack& pack, int side_px)
      : key_(key), pack_(pack), side_px_(side_px) {}

  [[nodiscard]] SheetCard card(const design::KeyedStimulus& stimulus) const {
    const GreyImage image = engine::read_grey_image(path_of(stimulus.stimulus));
    const engine::PackEntry& entry = checked_entry(stimulus, image);
    const engine::MappedField field = pack_.map(stimulus.code);
    SheetCard card = named(stimulus);
    card.geometry = field.view().geometry;
    card.gains = entry.gains;
    card.statistics = engine::field_statistics(field.view(), entry.gains, key_.study.rendering);
    draw(card, image, field.view(), stimulus.stimulus);
    return card;
  }

 private:
  [[nodiscard]] const design::StudyClass& class_of(const design::StimulusIndex& stimulus) const {
    return key_.study.classes[static_cast<std::size_t>(stimulus.class_index)];
  }
  [[nodiscard]] const std::filesystem::path& image_of(const design::StimulusIndex& stimulus) const {
    return class_of(stimulus).images[static_cast<std::size_t>(stimulus.exemplar)];
  }
  [[nodiscard]] std::filesystem::path path_of(const design::StimulusIndex& stimulus) const {
    return key_.study.folder / image_of(stimulus);
  }
  [[nodiscard]] const design::StudyMethod& method_of(const design::StimulusIndex& stimulus) const {
    return key_.study.methods[static_cast<std::size_t>(stimulus.method)];
  }

  [[nodiscard]] const engine::PackEntry& checked_entry(const design::KeyedStimulus& stimulus,
                                                       const GreyImage& image) const {
    const engine::PackEntry& entry = pack_.entry(stimulus.code);
    if (!design::is_made_from(entry, key_, image, stimulus.stimulus)) {
      refuse(pack_, "field " + stimulus.code + " was not made from " +
                        path_of(stimulus.stimulus).string() + " as it is now");
    }
    if (!pack_.is_intact(stimulus.code)) refuse(pack_, "field " + stimulus.code + " is damaged");
    return entry;
  }

  [[nodiscard]] SheetCard named(const design::KeyedStimulus& stimulus) const {
    const design::StimulusIndex& index = stimulus.stimulus;
    const std::size_t exemplars = class_of(index).images.size();
    SheetCard card;
    card.label = one_line(class_of(index).label);
    if (exemplars > 1) card.exemplar = fmt::format("{} of {}", index.exemplar + 1, exemplars);
    card.method = in_words(method_of(index));
    card.code = stimulus.code;
    card.image = one_line(image_of(index).filename().string());
    return card;
  }

  void draw(SheetCard& card, const GreyImage& image, engine::FieldView field,
            const design::StimulusIndex& stimulus) const {
    Plane<float> plane =
        engine::extract_texture<float>(image, design::method_of(key_.study, stimulus)).texture;
    const GreyImage texture = engine::texture_picture(plane);
    const auto [force, n_per_grey] = engine::lateral_field(field, card.gains);
    const double scale = fitting_scale(image.height(), image.width(), side_px_);
    card.patch = shown_patch(force);
    card.arrow_n = card.patch.force_of_unit_arrow * n_per_grey;
    card.picture = fitted(image, side_px_);
    card.texture = framed(fitted(enhanced_picture(std::move(plane)), side_px_), card.patch, scale);
    card.arrows = engine::force_arrows(texture, force, card.patch, side_px_);
    card.picture_entropy = engine::entropy(image);
    card.texture_entropy = engine::entropy(texture);
  }

  const design::StudyKey& key_;
  const engine::Pack& pack_;
  int side_px_;
};

/// Groups of stimuli for one line: of one method, and of one class if classes have several images.
std::vector<std::vector<design::KeyedStimulus>> groups_of(const design::StudyKey& key) {
  const bool several = std::ranges::any_of(
      key.study.classes, [](const design::StudyClass& one) { return one.images.size() > 1; });
  std::vector<design::KeyedStimulus> stimuli = key.stimuli;
  const auto group = [several](const design::KeyedStimulus& stimulus) {
    return std::pair(stimulus.stimulus.method, several ? stimulus.stimulus.class_index : 0);
  };
  const auto place = [&](const design::KeyedStimulus& stimulus) {
    return std::pair(group(stimulus), stimulus.stimulus);
  };
  std::ranges::sort(stimuli, {}, place);
  std::vector<std::vector<design::KeyedStimulus>> groups;
  for (const design::KeyedStimulus& stimulus : stimuli) {
    if (groups.empty() || group(groups.back().front()) != group(stimulus)) groups.emplace_back();
    groups.back().push_back(stimulus);
  }
  return groups;
}

/// Lines of nearly the same length.
std::vector<std::vector<design::KeyedStimulus>> lines_of(const design::StudyKey& key) {
  std::vector<std::vector<design::KeyedStimulus>> lines;
  for (const auto& group : groups_of(key)) {
    const std::size_t count = (group.size() + kMaxSheetColumns - 1) / kMaxSheetColumns;
    for (std::size_t i = 0; i < count; ++i) {
      const auto begin = group.begin() + static_cast<std::ptrdiff_t>(group.size() * i / count);
      const auto end = group.begin() + static_cast<std::ptrdiff_t>(group.size() * (i + 1) / count);
      lines.emplace_back(begin, end);
    }
  }
  return lines;
}

void check(const design::StudyKey& key, const engine::Pack& pack, int side_px) {
  if (side_px < 1) throw std::invalid_argument("make_stimulus_sheet: side_px is below 1");
  if (key.stimuli.size() > kMaxSheetStimuli) {
    throw UsageError(fmt::format(
        "stimuli sheet: the study has {} stimuli, more than the {} that one sheet holds; make "
        "sheets of studies with fewer images",
        key.stimuli.size(), kMaxSheetStimuli));
  }
  if (pack.manifest().study_id != key.study_id) {
    refuse(pack, "is unfinished, or belongs to another key");
  }
}

}  // namespace

StimulusSheet make_stimulus_sheet(const design::StudyKey& key, const engine::Pack& pack,
                                  int side_px,
                                  const std::function<void(int done, int of)>& progress) {
  check(key, pack, side_px);
  StimulusSheet sheet{key.study.name,
                      key.study.protocol_name(),
                      in_words(key.study.rendering),
                      to_hex(key.seal),
                      key.simulated,
                      side_px,
                      {}};
  const Cards cards(key, pack, side_px);
  int done = 0;
  for (const auto& line : lines_of(key)) {
    sheet.lines.emplace_back();
    for (const design::KeyedStimulus& stimulus : line) {
      sheet.lines.back().push_back(cards.card(stimulus));
      if (progress) progress(++done, static_cast<int>(key.stimuli.size()));
    }
  }
  return sheet;
}

}  // namespace touchtrial::analysis
