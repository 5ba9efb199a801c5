#include "core/errors.hpp"
#include "protocols/design/laboratory.hpp"
#include "protocols/design/pack_upkeep.hpp"
#include "protocols/design/stimulus_field.hpp"
#include "support/catch.hpp"

#include <string>
#include <vector>

namespace touchtrial {
namespace {

using nlohmann::json;

std::string text_of_stages(const std::vector<engine::Stage>& stages) {
  std::string text;
  for (const engine::Stage& stage : stages) {
    text += stage.name + " " + std::string(name_of(stage.state)) + "; ";
  }
  return text;
}

/// The stages of each stimulus in words, and those of the study last.
std::vector<std::string> explained(const Laboratory& laboratory) {
  const design::PrepareReport report =
      design::prepare_pack(laboratory.key(), laboratory.pack(), {}, {.explain = true});
  std::vector<std::string> texts;
  for (const design::PreparedStimulus& stimulus : report.stimuli) {
    texts.push_back(text_of_stages(stimulus.stages));
  }
  texts.push_back(text_of_stages(report.study_stages));
  return texts;
}

const std::string kBuilt =
    "read image computed; sub-bands computed; order map computed; texture computed; control "
    "skipped; filter computed; force planes skipped; write field computed; statistics computed; ";
const std::string kReused = "read image computed; field reused; statistics computed; ";

}  // namespace

TEST_CASE("an explanation lists what was computed and reused, and costs nothing unless requested") {
  Laboratory laboratory;
  CHECK(laboratory.prepare().stimuli[0].stages.empty());
  std::filesystem::remove_all(laboratory.pack());
  const std::string written = "gains computed; pack.json computed; ";
  CHECK(explained(laboratory) == std::vector<std::string>{kBuilt, kBuilt, kBuilt, written});
  CHECK(explained(laboratory) ==
        std::vector<std::string>{kReused, kReused, kReused, "gains computed; pack.json reused; "});
  write_noise(laboratory.image(1), 77);
  CHECK(explained(laboratory) == std::vector<std::string>{kReused, kBuilt, kReused, written});
  laboratory.document["rendering"] = {{"texture_stiffness_n_per_mm", 0.2}};
  CHECK(explained(laboratory) == std::vector<std::string>{kReused, kReused, kReused, written});
  laboratory.document["methods"][0]["radius"] = 3;
  CHECK(explained(laboratory) == std::vector<std::string>{kBuilt, kBuilt, kBuilt, written});
}

TEST_CASE("an explanation distinguishes a damaged field from one that never existed") {
  const Laboratory laboratory;
  const design::StudyKey key = laboratory.key();
  const auto why_written = [&] {
    const design::PrepareReport report =
        design::prepare_pack(key, laboratory.pack(), {}, {.explain = true});
    const auto& stages = report.stimuli[0].stages;
    const auto written = std::ranges::find(stages, "write field", &engine::Stage::name);
    return written == stages.end() ? std::string() : written->why;
  };
  CHECK(why_written() == "the pack had no field of this picture with these options");
  std::filesystem::remove(laboratory.pack() / (key.stimuli[0].code + ".field"));
  CHECK(why_written() == "the pack's field was damaged or missing");
}

TEST_CASE("an explanation gives reasons and bytes, and never a code") {
  const Laboratory laboratory;
  const design::StudyKey key = laboratory.key();
  const design::PrepareReport report =
      design::prepare_pack(key, laboratory.pack(), {}, {.explain = true});
  const design::PreparedStimulus& first = report.stimuli.front();
  for (const engine::Stage& stage : first.stages) {
    INFO(stage.name);
    CHECK_FALSE(stage.why.empty());
    CHECK(stage.why.find(key.stimuli[0].code) == std::string::npos);
    CHECK(stage.bytes > 0);
    CHECK((stage.seconds > 0.0) == (stage.state == engine::StageState::computed));
  }
  CHECK(first.stages[3].bytes == kSide * kSide * sizeof(double));
  CHECK(first.stages[7].bytes == first.bytes);
}

TEST_CASE("a flat image is not extracted, and its field is what an extraction would give") {
  Laboratory laboratory;
  for (std::uint64_t c = 0; c < 3; ++c)
    engine::write_png(laboratory.image(c), GreyImage(kSide, kSide, 90));
  for (const char* method : {"adaptive", "luminance", "tv-gabor"}) {
    INFO(method);
    laboratory.document["methods"] = {{{"name", method}}};
    CHECK(explained(laboratory)[0] ==
          "read image computed; sub-bands skipped; order map skipped; texture skipped; control "
          "skipped; filter skipped; filter computed; force planes skipped; write field computed; "
          "statistics "
          "computed; ");
    const design::StudyKey key = laboratory.key();
    const auto texture = engine::extract_texture<double>(
                             engine::read_grey_image(laboratory.image(0)), key.study.methods[0])
                             .texture;
    const engine::TextureField expected = engine::make_texture_field(texture, key.study.rendering);
    const engine::MappedField field = engine::Pack(laboratory.pack()).map(key.stimuli[0].code);
    CHECK(std::ranges::equal(field.view().heights, expected.view().heights));
  }
}

TEST_CASE("no model makes force planes, and it is said how many bytes that saves") {
  Laboratory laboratory;
  laboratory.document["rendering"] = {{"model", "surface"}};
  CHECK(explained(laboratory)[0] ==
        "read image computed; sub-bands computed; order map computed; texture computed; control "
        "skipped; filter, spline computed; force planes skipped; write field computed; statistics "
        "computed; ");
  laboratory.document["rendering"]["filter_mm"] = 0.3;
  const design::PrepareReport report =
      design::prepare_pack(laboratory.key(), laboratory.pack(), {}, {.explain = true});
  CHECK(report.stimuli[0].stages[6].bytes == kSide * kSide * 8);
}

TEST_CASE("a method without sub-bands skips them, and statistics are skipped unless requested") {
  Laboratory laboratory;
  laboratory.document["methods"] = {{{"name", "fixed"}}};
  const design::PrepareReport report = design::prepare_pack(laboratory.key(), laboratory.pack(), {},
                                                            {.statistics = false, .explain = true});
  CHECK(
      text_of_stages(report.stimuli[0].stages) ==
      "read image computed; sub-bands skipped; order map skipped; texture computed; control "
      "skipped; filter computed; force planes skipped; write field computed; statistics skipped; ");
  CHECK(report.stimuli[0].stages[1].why == "one order serves the whole image");
  CHECK(report.stimuli[0].statistics.tangential_rms_n == 0.0);
}

TEST_CASE("a method's control is made of its texture, which is taken once, and differs by image") {
  Laboratory laboratory;
  std::filesystem::copy_file(laboratory.image(0), laboratory.image(2),
                             std::filesystem::copy_options::overwrite_existing);
  laboratory.document["protocol"] = "comparison";
  laboratory.document["methods"] = {{{"name", "adaptive"}},
                                    {{"name", "adaptive"}, {"control", "phase-scrambled"}}};
  const std::vector<std::string> texts = explained(laboratory);
  CHECK(texts[1] ==
        "read image reused; texture reused; control computed; filter computed; force planes "
        "skipped; write field computed; statistics computed; ");
  const design::StudyKey key = laboratory.key();
  const GreyImage image = engine::read_grey_image(laboratory.image(0));
  const engine::ExtractionOptions control = design::method_of(key.study, {0, 0, 1});
  const auto texture = engine::extract_texture<double>(image, control).texture;
  const engine::TextureField expected = engine::make_texture_field(texture, key.study.rendering);
  const engine::Pack pack(laboratory.pack());
  const engine::MappedField field = pack.map(key.code_of({0, 0, 1}));
  CHECK(std::ranges::equal(field.view().heights, expected.view().heights));
  CHECK(pack.entry(key.code_of({0, 0, 1})).checksum != pack.entry(key.code_of({2, 0, 1})).checksum);
  CHECK(pack.entry(key.code_of({0, 0, 0})).checksum == pack.entry(key.code_of({2, 0, 0})).checksum);
  const design::PrepareReport again = laboratory.prepare();
  CHECK(reused(again) == 6);
  CHECK(again.stimuli[1].method == "adaptive-phase-scrambled");
  laboratory.document["seed"] = 5;
  CHECK(reused(laboratory.prepare()) == 3);
}

TEST_CASE("large images, which are prepared one at a time, give the pack of small ones") {
  Laboratory laboratory;
  engine::write_png(laboratory.image(1), GreyImage(3, 5, 7));
  static_cast<void>(laboratory.prepare());
  const auto whole = laboratory.files();
  std::filesystem::remove_all(laboratory.pack());
  int done = 0;
  const design::PrepareReport report = design::prepare_pack(
      laboratory.key(), laboratory.pack(), [&](int count, int) { done = count; },
      {.explain = true, .large_image_px = kSide * kSide - 1});
  CHECK(laboratory.files() == whole);
  CHECK(done == 3);
  CHECK(text_of_stages(report.stimuli[0].stages) == kBuilt);
  CHECK(report.stimuli[0].statistics.tangential_rms_n > 0.0);
}

}  // namespace touchtrial
