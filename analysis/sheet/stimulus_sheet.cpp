#include "analysis/sheet/stimulus_sheet.hpp"

#include "analysis/report/page/picture_tiles.hpp"
#include "core/errors.hpp"
#include "engine/image_file.hpp"
#include "engine/metrics/picture_statistics.hpp"
#include "engine/pictures/colour_image.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "study/practice.hpp"
#include "study/prepare.hpp"
#include "study/stimulus_field.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr const char* kUnblindingWarning =
    "This sheet unblinds: it shows which code is which stimulus. Keep it with the key, away from "
    "participants and experimenters.";
constexpr int kPictureSide_px = 240;
constexpr int kPatchSide_px = 16;
/// In CSS pixels: four rows fill a printed page.
constexpr int kTileSide_px = 200;
constexpr std::size_t kStimuliPerPicture = 4;

std::string to_3_digits(double number) {
  return fmt::format("{:.3g}", number);
}

std::string percent_text(double share) {
  return fmt::format("{:.1f}", 100 * share);
}

/// The height gain or the force gains, depending on the study's model.
std::string gains_text(const engine::Gains& gains) {
  if (gains.height_mm > 0.0) return to_3_digits(1000 * gains.height_mm) + " um of height";
  return to_3_digits(1000 * gains.tangential_n) + " / " + to_3_digits(1000 * gains.normal_n) +
         " mN";
}

struct Group {
  std::string id;
  std::string title;
  std::vector<study::KeyedStimulus> stimuli;
};

/// One group per method, then practice; groups without stimuli are left out.
std::vector<Group> groups_of(const study::StudyKey& key) {
  std::vector<Group> groups;
  for (const study::StudyMethod& method : key.study.methods) {
    groups.push_back({fmt::format("method-{}", groups.size() + 1), method.label, {}});
  }
  for (const study::KeyedStimulus& keyed : key.stimuli) {
    groups[static_cast<std::size_t>(keyed.stimulus.method)].stimuli.push_back(keyed);
  }
  groups.push_back({"practice", "Practice", key.practice});
  std::erase_if(groups, [](const Group& group) { return group.stimuli.empty(); });
  for (Group& group : groups) {
    std::ranges::sort(group.stimuli, {}, &study::KeyedStimulus::stimulus);
  }
  return groups;
}

Table empty_table(std::size_t group) {
  Table table{fmt::format("stimuli-{}", group + 1),
              "Stimuli and their codes, and the statistics of their fields",
              {{"stimulus", Align::left}, {"code", Align::left}, {"image", Align::left}}};
  for (const char* title :
       {"size, mm", "lateral force, rms, N", "lateral force, 99.9th percentile, N",
        "normal force, rms, N", "stiffness, 99th percentile, N/mm", "power at 1 mm and longer, %",
        "power up to 250 Hz at 100 mm/s, %", "entropy, picture / texture, nats",
        "gains of a grey level", "force of an arrow of one pixel, N"}) {
    table.columns.push_back({title});
  }
  return table;
}

GreyImage resized_to_picture(const GreyImage& image) {
  const double scale =
      static_cast<double>(kPictureSide_px) / std::max(image.height(), image.width());
  const auto side = [scale](int length) {
    return std::max(1, static_cast<int>(std::lround(length * scale)));
  };
  return engine::resized(image, side(image.height()), side(image.width()));
}

/// The texture with its contrast enhanced equally for all stimuli.
GreyImage enhanced_picture(Plane<float> texture) {
  constexpr float kContrast = 3.0F;
  for (float& grey : texture.samples()) grey *= kContrast;
  return engine::texture_picture(texture);
}

class SheetRows {
 public:
  SheetRows(const study::StudyKey& key, const engine::Pack& pack) : key_(key), pack_(pack) {}

  void add(const study::KeyedStimulus& keyed, Table& table, Tiles& tiles) {
    const study::StimulusIndex& stimulus = keyed.stimulus;
    const study::StudyClass& stimulus_class = key_.study.class_at(stimulus.class_index);
    const auto exemplar = static_cast<std::size_t>(stimulus.exemplar);
    const auto [picture, notes] =
        engine::read_picture(key_.study.folder / stimulus_class.images[exemplar]);
    const GreyImage image = rendered_part(picture, stimulus);
    const engine::PackEntry& entry = checked_entry(keyed, image, stimulus_class.images[exemplar]);
    const engine::MappedField field = pack_.map(keyed.code);
    Plane<float> plane =
        engine::extract_texture<float>(image, study::method_of(key_.study, stimulus)).texture;
    const GreyImage texture = engine::texture_picture(plane);
    const auto [force, n_per_grey] = engine::lateral_field(field.view(), entry.gains);
    const engine::ArrowPatch patch = middle_of_patch(engine::strongest_patch(force), kPatchSide_px);
    const engine::FieldStatistics statistics =
        engine::field_statistics(field.view(), entry.gains, key_.study.rendering);
    const PlaneGeometry& geometry = field.view().geometry;
    for (const std::string& remark : engine::remarks_on(notes)) {
      remarks_.insert(one_line(stimulus_class.images[exemplar].string() + ": " + remark));
    }
    const std::string title = stimulus_class.images.size() > 1
                                  ? fmt::format("{}, {} of {}", stimulus_class.label, exemplar + 1,
                                                stimulus_class.images.size())
                                  : stimulus_class.label;
    table.rows.push_back(
        {title, keyed.code, stimulus_class.images[exemplar].filename().string(),
         fmt::format("{:g} x {:g}", geometry.width_mm(), geometry.height_mm()),
         to_3_digits(statistics.tangential_rms_n), to_3_digits(statistics.tangential_p999_n),
         to_3_digits(statistics.normal_rms_n), to_3_digits(statistics.stiffness_p99_n_per_mm),
         percent_text(1 - statistics.share_below_1_mm),
         percent_text(1 - statistics.share_above_250_hz[1]),
         fmt::format("{:.2f} / {:.2f}", engine::entropy(image), engine::entropy(texture)),
         gains_text(entry.gains), fmt::format("{:.2g}", patch.force_of_unit_arrow * n_per_grey)});
    tiles.labels.push_back(title);
    tiles.cells.push_back(
        {engine::png_bytes(resized_to_picture(picture)),
         engine::png_bytes(resized_to_picture(enhanced_picture(std::move(plane)))),
         engine::png_bytes(engine::force_arrows(texture, force, patch, kPictureSide_px))});
  }

  /// Warnings about the pictures, as `prepare` prints them; empty if there are none.
  [[nodiscard]] Warnings remarks() const {
    return {{remarks_.begin(), remarks_.end()}, "Warnings about the pictures"};
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw VerificationError(one_line(pack_.folder().string()) + ": " + what +
                            "; run touchtrial prepare, then make the sheet again");
  }

 private:
  /// The part of the picture that the field was made from.
  [[nodiscard]] GreyImage rendered_part(const GreyImage& picture,
                                        const study::StimulusIndex& stimulus) const {
    if (!key_.study.is_practice_class(stimulus.class_index)) return picture;
    return study::middle_of(picture, study::plane_of(key_.study));
  }

  [[nodiscard]] const engine::PackEntry& checked_entry(const study::KeyedStimulus& keyed,
                                                       const GreyImage& image,
                                                       const std::filesystem::path& name) const {
    const engine::PackEntry& entry = pack_.entry(keyed.code);
    if (!study::is_made_from(entry, key_, image, keyed.stimulus)) {
      refuse("field " + keyed.code + " was not made from the current " +
             one_line((key_.study.folder / name).string()));
    }
    if (!pack_.is_intact(keyed.code)) refuse("field " + keyed.code + " is damaged");
    return entry;
  }

  const study::StudyKey& key_;
  const engine::Pack& pack_;
  std::set<std::string> remarks_;
};

Picture picture_of(const Tiles& tiles, std::size_t number) {
  std::string alt = "Rows:";
  for (const std::string& label : tiles.labels) alt += " " + label + ";";
  return picture_of_tiles(fmt::format("stimuli-{}", number),
                          "The picture as participants see it; its texture with three times the "
                          "contrast, mid-grey where there is none; the lateral force in its "
                          "strongest part, from the pack, with arrows from bright to dark.",
                          alt + " columns: picture, texture, lateral force.", tiles);
}

}  // namespace

Document make_stimulus_sheet(const study::StudyKey& key, const engine::Pack& pack,
                             const std::function<void(int finished, int total)>& progress) {
  const std::size_t total = key.fields().size();
  if (total > kMaxSheetStimuli) {
    throw UsageError(
        fmt::format("stimuli sheet: the study has {} stimuli, and a sheet holds at most {}; make a "
                    "sheet of a study with fewer images",
                    total, kMaxSheetStimuli));
  }
  SheetRows rows(key, pack);
  if (pack.manifest().study_id != key.study_id) {
    rows.refuse("is unfinished, or belongs to another key");
  }
  Document sheet;
  sheet.title = "Stimuli of the study " + key.study.name;
  sheet.stamp = key.simulated ? "SIMULATED" : "";
  sheet.banners = {kUnblindingWarning};
  sheet.numbered = false;
  sheet.about = "This sheet";
  sheet.header.entries = {{"protocol", key.study.protocol_name()}, {"seal", to_hex(key.seal)}};
  const Tiles no_tiles{{"picture", "texture", "lateral force"}, {}, {}, kTileSide_px};
  std::size_t done = 0;
  std::size_t pictures = 0;
  for (const Group& group : groups_of(key)) {
    Table table = empty_table(sheet.sections.size());
    std::vector<Block> picture_blocks;
    Tiles tiles = no_tiles;
    for (const study::KeyedStimulus& keyed : group.stimuli) {
      rows.add(keyed, table, tiles);
      if (progress) progress(static_cast<int>(++done), static_cast<int>(total));
      if (tiles.cells.size() < kStimuliPerPicture && &keyed != &group.stimuli.back()) continue;
      picture_blocks.emplace_back(picture_of(std::exchange(tiles, no_tiles), ++pictures));
    }
    Section& section = sheet.sections.emplace_back(Section{group.id, group.title, {}});
    section.blocks.emplace_back(std::move(table));
    std::ranges::move(picture_blocks, std::back_inserter(section.blocks));
  }
  if (!rows.remarks().sentences.empty()) {
    sheet.sections.front().blocks.emplace_back(rows.remarks());
  }
  return sheet;
}

}  // namespace touchtrial::analysis
