#include "protocols/session/tiny_study.hpp"

#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "study/practice.hpp"
#include "study/signed_pack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <span>
#include <vector>

namespace touchtrial {
namespace {

struct Weave {
  const char* label;
  double wavelength_px;
  double direction_deg;
};
constexpr std::array<Weave, 5> kWeaves = {{{"bark", 12.0, 0.0},
                                           {"cloth", 8.0, 90.0},
                                           {"pebbles", 24.0, 45.0},
                                           {"straw", 10.0, 135.0},
                                           {"brick", 40.0, 90.0}}};

study::Study study_with(const TinyStudyOptions& options) {
  std::string classes;
  for (const Weave& weave : kWeaves) {
    std::string images;
    for (int i = 0; i < options.images; ++i) {
      images += std::string(i > 0 ? "," : "") + "\"" + weave.label + std::to_string(i) + ".png\"";
    }
    classes += std::string(classes.empty() ? "" : ",") + R"({"label":")" + weave.label +
               R"(","images":[)" + images + "]}";
  }
  const std::string methods = options.comparison ? R"([{"name":"adaptive"},{"name":"tv-gabor"}])"
                                                 : R"([{"name":"adaptive"}])";
  const std::string protocol = !options.protocol.empty() || options.section.empty()
                                   ? options.protocol
                               : options.comparison ? "comparison"
                                                    : "classification";
  const std::string section = options.protocol.empty() || options.section.empty()
                                  ? ""
                                  : ",\"" + options.protocol + "\":" + options.section;
  const std::string visits = options.visits.empty() ? "" : ",\"visits\":" + options.visits;
  std::string practice;
  for (int i = 0; i < options.practised; ++i) {
    const std::string name = "practice" + std::to_string(i);
    practice += std::string(practice.empty() ? R"(,"practice":{"criterion":0,"classes":[)" : ",") +
                R"({"label":")" + name + R"(","images":[")" + name + R"(.png"]})";
  }
  if (!practice.empty()) practice += "]}";
  return study::parse_study(R"({"study":"tiny","protocol":")" + protocol + R"(","classes":[)" +
                                classes + R"(],"methods":)" + methods + R"(,"trials":)" +
                                options.trials + R"(,"rendering":)" + options.rendering + section +
                                visits + practice + R"(,"seed":)" + std::to_string(kTinyStudySeed) +
                                "}",
                            ".", "tiny.json");
}

study::StudyKey key_with(const TinyStudyOptions& options) {
  SeededEntropy entropy(options.secret);
  study::StudyKey key = study::make_study_key(study_with(options), entropy, true);
  if (options.schedules != 0) {
    key.stations.front().secret = SeededEntropy(options.schedules).secret("station");
  }
  return key;
}

engine::Gains times(double factor, const engine::Gains& gains) {
  return {.tangential_n = factor * gains.tangential_n,
          .normal_n = factor * gains.normal_n,
          .height_mm = factor * gains.height_mm};
}

engine::Pack write_pack(const std::filesystem::path& folder, const study::StudyKey& key,
                        const TinyStudyOptions& options) {
  std::vector<engine::TextureField> fields;
  const std::vector<study::KeyedStimulus> all = key.fields();
  for (const study::KeyedStimulus& keyed : all) {
    fields.push_back(engine::make_texture_field(tiny_texture(keyed.stimulus, options.side_px),
                                                key.study.rendering));
  }
  std::vector<engine::FieldView> views;
  for (const engine::TextureField& field : fields) views.push_back(field.view());
  const std::span<const engine::FieldView> every(views);
  std::vector<engine::Gains> gains =
      engine::choose_gains(every.first(key.stimuli.size()), key.study.rendering).per_field;
  std::ranges::copy(
      study::practice_gains(every.subspan(key.stimuli.size()), gains, key.study.rendering),
      std::back_inserter(gains));
  std::filesystem::create_directories(folder);
  engine::PackManifest manifest{key.study_id, {}};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string& code = all[i].code;
    const Digest checksum = engine::write_field(folder, code, views[i]);
    const bool is_first = all[i].stimulus.class_index == 0;
    const double factor = options.smooth ? 0.0 : (is_first ? options.first_gain : 1.0);
    manifest.entries.push_back({code, checksum, {}, times(factor, gains[i])});
  }
  study::sign(manifest, key,
              options.pictures ? study::picture_digests(key.study) : std::vector<Digest>());
  engine::write_manifest(folder, manifest);
  return engine::Pack(folder);
}

void write_picture(const Plane<double>& texture, const std::filesystem::path& path) {
  GreyImage picture(texture.height(), texture.width());
  std::ranges::transform(texture.samples(), picture.samples().begin(), [](double sample) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(128.0 + sample), 0L, 255L));
  });
  engine::write_png(path, picture);
}

study::StudyKey key_in(const std::filesystem::path& folder, const TinyStudyOptions& options) {
  study::StudyKey key = key_with(options);
  if (!options.pictures) return key;
  key.study.folder = folder;
  const auto classes = static_cast<int>(key.study.classes.size()) + options.practised;
  for (int i = 0; i < classes; ++i) {
    write_picture(tiny_texture({.class_index = i}, options.side_px),
                  folder / key.study.class_at(i).images.front());
  }
  return key;
}

}  // namespace

Plane<double> tiny_texture(const study::StimulusIndex& stimulus, int side_px) {
  const auto shown = static_cast<std::size_t>(stimulus.class_index);
  const Weave& weave = kWeaves[shown % kWeaves.size()];
  // Textures of practice are like the study's.
  const int image =
      stimulus.exemplar + 100 * stimulus.method + 10000 * static_cast<int>(shown / kWeaves.size());
  RandomStream random(static_cast<std::uint64_t>(image), weave.label);
  Plane<double> texture(side_px, side_px);
  constexpr int kWaves = 12;
  for (int wave = 0; wave < kWaves; ++wave) {
    const double angle =
        (weave.direction_deg + random.uniform(-15.0, 15.0)) * std::numbers::pi / 180.0;
    const double per_px =
        2.0 * std::numbers::pi /
        (weave.wavelength_px * random.uniform(0.85, 1.15) * (1.0 + 0.3 * stimulus.method));
    const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    for (int y = 0; y < side_px; ++y) {
      for (int x = 0; x < side_px; ++x) {
        const double along = x * std::cos(angle) + y * std::sin(angle);
        texture.at(y, x) += 8.0 * std::sin(per_px * along + phase);
      }
    }
  }
  return texture;
}

TinyStudy::TinyStudy(const TinyStudyOptions& options)
    : key_(key_in(folder_.path(), options)),
      pack_(write_pack(folder_.path() / "tiny.sim.pack", key_, options)) {}

std::filesystem::path TinyStudy::next_database() {
  return folder_.path() / (std::to_string(++databases_) + ".db");
}

}  // namespace touchtrial
