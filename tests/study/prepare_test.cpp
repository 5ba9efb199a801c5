#include "study/prepare.hpp"

#include "core/errors.hpp"
#include "study/laboratory.hpp"
#include "study/pack_upkeep.hpp"
#include "study/signed_pack.hpp"
#include "study/stimulus_field.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial {

using nlohmann::json;

namespace {

/// The field that the engine makes of an image and a method is the one in the pack.
void check_field(const Laboratory& laboratory, const engine::ExtractionOptions& method,
                 std::uint64_t image, const std::string& code) {
  const GreyImage grey = engine::read_grey_image(laboratory.image(image));
  const auto texture = engine::extract_texture<double>(grey, method).texture;
  const engine::TextureField expected =
      engine::make_texture_field(texture, laboratory.key().study.rendering);
  const engine::MappedField field = engine::Pack(laboratory.pack()).map(code);
  CHECK(std::ranges::equal(field.view().heights, expected.view().heights));
}

}  // namespace

TEST_CASE("packs and keys lie beside the study file, or where one says") {
  CHECK(study::default_pack_place("dir/x.json").pack == "dir/x.pack");
  CHECK(study::default_pack_place("dir/x.json").key == "dir/x.key");
  CHECK(study::default_pack_place("x.y.json").key == "x.y.key");
  CHECK(study::simulated_pack_place("dir/x.json").pack == "dir/x.sim.pack");
  CHECK(study::simulated_pack_place("dir/x.json").key.empty());
  CHECK(study::pack_place_at("there/a.pack").key == "there/a.key");
  CHECK(study::pack_place_at("there/a.pack/").pack == "there/a.pack");
  CHECK(study::pack_place_at("there/a.pack/").key == "there/a.key");
  CHECK(study::pack_place_at("there/a.b").key == "there/a.b.key");
  // The key never lies in the folder that stations get.
  CHECK(study::pack_place_at("there/a.pack/.").key == "there/a.key");
  CHECK(study::pack_place_at("there/b/../a.pack").key == "there/a.key");
  const auto here = std::filesystem::current_path();
  CHECK(study::pack_place_at(".").key.parent_path() == here.parent_path());
  CHECK(study::pack_place_at("..").key.parent_path() == here.parent_path().parent_path());
}

TEST_CASE("prepare makes a field for every stimulus, under its code, with the chosen gains") {
  const Laboratory laboratory;
  const study::StudyKey key = laboratory.key();
  const study::PrepareReport report = laboratory.prepare();
  CHECK(report.stimuli.size() == 3);
  CHECK(reused(report) == 0);
  CHECK(report.warnings.empty());
  CHECK(report.skipped.empty());
  const engine::Pack pack(laboratory.pack());
  CHECK(pack.manifest().study_id == key.study_id);
  REQUIRE(pack.manifest().entries.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string& code = key.stimuli[i].code;
    const study::PreparedStimulus& prepared = report.stimuli[i];
    CHECK(prepared.class_label == "c" + std::to_string(i));
    CHECK(prepared.method == "adaptive");
    CHECK(pack.is_intact(code));
    CHECK(pack.entry(code).gains == prepared.gains);
    CHECK(prepared.gains == report.stimuli[0].gains);
    CHECK(prepared.gains.tangential_n > 0.0);
    const engine::MappedField field = pack.map(code);
    CHECK(field.view().geometry.width_px == kSide);
    CHECK(prepared.bytes > kSide * kSide * sizeof(float));
    const engine::FieldStatistics expected = engine::field_statistics(field.view(), prepared.gains);
    CHECK(prepared.statistics.tangential_rms_n == expected.tangential_rms_n);
    CHECK(prepared.statistics.tangential_rms_n > 0.0);
  }
}

TEST_CASE("a field is what the engine makes of the image") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const study::StudyKey key = laboratory.key();
  check_field(laboratory, key.study.methods[0], 1, key.stimuli[1].code);
}

TEST_CASE("a second prepare builds nothing and writes nothing") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const auto before = std::filesystem::last_write_time(laboratory.pack() / "pack.json");
  const auto files = laboratory.files();
  const study::PrepareReport again = laboratory.prepare();
  CHECK(reused(again) == 3);
  CHECK(std::filesystem::last_write_time(laboratory.pack() / "pack.json") == before);
  CHECK(laboratory.files() == files);
}

TEST_CASE("the same key and images give the same pack, byte by byte") {
  const Laboratory one;
  const Laboratory other;
  static_cast<void>(one.prepare());
  static_cast<void>(other.prepare());
  CHECK(one.files() == other.files());
}

TEST_CASE("only what changed is built again") {
  Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  write_noise(laboratory.image(1), 77);
  const study::PrepareReport image_changed = laboratory.prepare();
  CHECK(reused(image_changed) == 2);
  CHECK_FALSE(image_changed.stimuli[1].reused);

  laboratory.document["rendering"] = {{"max_force_n", 2.0}, {"texture_stiffness_n_per_mm", 0.2}};
  const study::PrepareReport gains_changed = laboratory.prepare();
  CHECK(reused(gains_changed) == 3);
  CHECK(gains_changed.stimuli[0].gains.tangential_n ==
        Approx(image_changed.stimuli[0].gains.tangential_n / 2.0));
  CHECK(engine::Pack(laboratory.pack()).manifest().entries[0].gains ==
        gains_changed.stimuli[0].gains);

  laboratory.document["rendering"] = {{"filter_mm", 0.3}};
  CHECK(reused(laboratory.prepare()) == 0);
  laboratory.document["methods"][0]["radius"] = 3;
  CHECK(reused(laboratory.prepare()) == 0);
  laboratory.document["methods"][0]["radius"] = 3.0;
  CHECK(reused(laboratory.prepare()) == 3);
}

TEST_CASE("a study with the surface model has packs of coefficients, of the same size") {
  Laboratory laboratory;
  const study::PrepareReport paper = laboratory.prepare();
  laboratory.document["rendering"] = {{"model", "surface"}};
  const study::PrepareReport report = laboratory.prepare();
  CHECK(reused(report) == 0);
  CHECK(reused(laboratory.prepare()) == 3);
  const engine::Pack pack(laboratory.pack());
  for (std::size_t i = 0; i < report.stimuli.size(); ++i) {
    const engine::MappedField field = pack.map(laboratory.key().stimuli[i].code);
    CHECK(field.view().model == engine::ModelKind::surface);
    CHECK(report.stimuli[i].gains.height_mm > 0.0);
    CHECK(report.stimuli[i].statistics.tangential_rms_n > 0.0);
    CHECK(report.stimuli[i].bytes == paper.stimuli[i].bytes);
  }
  laboratory.document["rendering"]["neighbourhood"] = 5;  // of no consequence to a surface
  CHECK(reused(laboratory.prepare()) == 3);
}

TEST_CASE("a damaged or missing field is built again") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const auto whole = laboratory.files();
  const study::StudyKey key = laboratory.key();
  const auto first = laboratory.pack() / (key.stimuli[0].code + ".field");
  Bytes content = read_file(first);
  content[content.size() / 2] ^= 1U;
  replace_file(first, ByteView(content));
  std::filesystem::remove(laboratory.pack() / (key.stimuli[2].code + ".field"));
  const study::PrepareReport report = laboratory.prepare();
  CHECK(reused(report) == 1);
  CHECK(report.stimuli[1].reused);
  CHECK(report.warnings.size() == 1);
  CHECK(warns(report, "2"));
  CHECK(laboratory.files() == whole);
}

TEST_CASE("a pack whose gains, fields or list the key did not sign is built anew, with a warning") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const auto whole = laboratory.files();
  engine::PackManifest manifest = engine::Pack(laboratory.pack()).manifest();
  SECTION("other gains") {
    manifest.entries[1].gains.tangential_n *= 20.0;
  }
  SECTION("two fields exchanged, with their checksums") {
    const auto file = [&](std::size_t i) {
      return study::field_path(laboratory.pack(), manifest.entries[i].code);
    };
    const Bytes first = read_file(file(0));
    replace_file(file(0), read_file(file(1)));
    replace_file(file(1), first);
    std::swap(manifest.entries[0].checksum, manifest.entries[1].checksum);
  }
  SECTION("another identity") {
    manifest.study_id = "00";
  }
  engine::write_manifest(laboratory.pack(), manifest);
  const study::PrepareReport report = laboratory.prepare();
  CHECK(reused(report) == 0);
  CHECK(warns(report, "pack.json"));
  CHECK(laboratory.files() == whole);
}

TEST_CASE("a picture that participants see is signed by its name and bytes, in no order of codes") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const study::StudyKey key = laboratory.key();
  CHECK_NOTHROW(study::require_complete_pack(engine::Pack(laboratory.pack()), key));
  const auto before = engine::Pack(laboratory.pack()).manifest().pictures;
  CHECK(before == study::picture_digests(key.study));
  CHECK(std::ranges::is_sorted(before));

  const Bytes first = read_file(laboratory.image(0));
  const Bytes second = read_file(laboratory.image(1));
  const auto refused = [&] {
    return refuses<FileError>(
        [&] {
          study::require_complete_pack(engine::Pack(laboratory.pack()), key);
          return 0;
        },
        laboratory.image(0).string());
  };
  replace_file(laboratory.image(0), second);
  replace_file(laboratory.image(1), first);
  CHECK(refused());
  replace_file(laboratory.image(1), second);
  std::filesystem::remove(laboratory.image(0));
  CHECK(refused());
  replace_file(laboratory.image(0), first);
  CHECK_NOTHROW(study::require_complete_pack(engine::Pack(laboratory.pack()), key));

  // Other bytes of the same pixels: the fields stay, and the list is signed anew.
  Bytes longer = first;
  longer.push_back(0);
  replace_file(laboratory.image(0), longer);
  CHECK(refused());
  CHECK(reused(laboratory.prepare()) == 3);
  CHECK_NOTHROW(study::require_complete_pack(engine::Pack(laboratory.pack()), key));
}

TEST_CASE("a pack is whole for its own investigator, and for the study as it was sealed") {
  Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const engine::Pack pack(laboratory.pack());
  const study::StudyKey key = laboratory.key();
  const auto refused = [&](auto change) {
    study::StudyCodes codes = key;
    change(codes);
    return refuses<FileError>([&] {
      study::require_complete_pack(pack, codes);
      return 0;
    });
  };
  using Codes = study::StudyCodes;
  CHECK(refused([](Codes& codes) { codes.study_id = "00"; }));
  CHECK(refused([](Codes& codes) { codes.investigator_signature[0] ^= 1U; }));
  CHECK(refused([](Codes& codes) { codes.investigator_box[0] ^= 1U; }));
  CHECK(refused([](Codes& codes) { codes.seal[0] ^= 1U; }));
  laboratory.document["trials"]["repeats"] = 9;
  const study::StudyKey changed = study::rekeyed(key, laboratory.key().study);
  CHECK_THROWS_AS(study::require_complete_pack(pack, changed), FileError);
  CHECK(reused(laboratory.prepare()) == 3);
  CHECK_NOTHROW(study::require_complete_pack(engine::Pack(laboratory.pack()), changed));
}

TEST_CASE("a damaged table of contents is replaced, with a warning") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const auto whole = laboratory.files();
  replace_file(laboratory.pack() / "pack.json", std::string("{\"format\""));
  const study::PrepareReport report = laboratory.prepare();
  CHECK(reused(report) == 0);
  CHECK_FALSE(report.warnings.empty());
  CHECK(laboratory.files() == whole);
}

TEST_CASE("a prepare that fails leaves the pack as it was, and its work to the next one") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const auto whole = laboratory.files();
  write_noise(laboratory.image(0), 91);
  write_noise(laboratory.image(1), 92);
  replace_file(laboratory.image(2), std::string("not an image"));
  CHECK_THROWS_AS(laboratory.prepare(), StudyError);
  const auto drafts = study::draft_folder(laboratory.pack());
  CHECK(std::filesystem::is_directory(drafts));
  for (const auto& [name, content] : whole) CHECK(read_file(laboratory.pack() / name) == content);
  CHECK_THROWS_AS(study::require_complete_pack(engine::Pack(drafts), laboratory.key()), FileError);

  std::filesystem::remove(laboratory.image(2));
  write_noise(laboratory.image(2), 2);
  CHECK(reused(laboratory.prepare()) == 3);
  for (std::uint64_t c = 0; c < 2; ++c) write_noise(laboratory.image(c), c);
  static_cast<void>(laboratory.prepare());
  CHECK(laboratory.files() == whole);
}

TEST_CASE("a prepare that fails with a new key leaves nothing") {
  const Laboratory laboratory;
  replace_file(laboratory.image(2), std::string("not an image"));
  const auto prepare = [&] {
    return study::prepare_pack(study::PackLock(laboratory.pack()), laboratory.key(), {},
                               {.is_new_key = true});
  };
  CHECK_THROWS_AS(prepare(), StudyError);
  CHECK_FALSE(std::filesystem::exists(laboratory.pack()));
}

TEST_CASE("a prepare that is killed between two renames is completed by the next one") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  for (std::uint64_t c = 0; c < 3; ++c) write_noise(laboratory.image(c), 90 + c);
  const auto broken_off = [&] { throw StudyError("broken off"); };
  CHECK_THROWS_AS(
      study::prepare_pack(laboratory.key(), laboratory.pack(), {}, {.publish_secrets = broken_off}),
      StudyError);
  // Fields are renamed in the order of their codes, the list last.
  const int renamed = GENERATE(0, 1, 2, 3);
  const auto drafts = study::draft_folder(laboratory.pack());
  const auto entries = engine::Pack(drafts).manifest().entries;
  REQUIRE(entries.size() == 3);
  for (int i = 0; i < renamed; ++i) {
    const std::string& code = entries[static_cast<std::size_t>(i)].code;
    std::filesystem::rename(study::field_path(drafts, code),
                            study::field_path(laboratory.pack(), code));
  }
  CHECK_THROWS_AS(study::require_complete_pack(engine::Pack(laboratory.pack()), laboratory.key()),
                  FileError);
  const study::PrepareReport completed = laboratory.prepare();
  CHECK(reused(completed) == 3);
  CHECK(completed.warnings.empty());
  CHECK_NOTHROW(study::require_complete_pack(engine::Pack(laboratory.pack()), laboratory.key()));
  CHECK_FALSE(std::filesystem::exists(drafts));
}

TEST_CASE("a field that is built anew has the time of all others") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  write_noise(laboratory.image(1), 77);
  static_cast<void>(laboratory.prepare());
  const auto time_of = [&](std::size_t i) {
    return std::filesystem::last_write_time(
        study::field_path(laboratory.pack(), laboratory.key().stimuli[i].code));
  };
  CHECK(time_of(0) == time_of(1));
  CHECK(time_of(1) == time_of(2));
}

TEST_CASE("fields of stimuli that are gone are removed, and other files stay") {
  Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const std::string gone = laboratory.key().stimuli[2].code;
  replace_file(laboratory.pack() / "notes.txt", std::string("mine"));
  replace_file(laboratory.pack() / "other.field", std::string("mine"));
  laboratory.document["classes"].erase(2);
  const study::PrepareReport report = laboratory.prepare();
  CHECK(reused(report) == 2);
  const auto files = laboratory.files();
  CHECK(files.count(gone + ".field") == 0);
  CHECK(files.count("notes.txt") == 1);
  CHECK(files.count("other.field") == 1);
  CHECK(engine::Pack(laboratory.pack()).manifest().entries.size() == 2);
}

TEST_CASE("nothing in a pack tells what it shows") {
  Laboratory laboratory;
  laboratory.document["classes"][0]["label"] = "sandpaper";
  static_cast<void>(laboratory.prepare());
  for (const auto& [name, content] : laboratory.files()) {
    for (const char* word : {"sandpaper", "c1_0", ".png", "adaptive"}) {
      CHECK(text_of(content).find(word) == std::string::npos);
      CHECK(name.find(word) == std::string::npos);
    }
  }
}

TEST_CASE("without the key an input tag cannot be looked up from the image") {
  Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const auto tags = engine::Pack(laboratory.pack()).manifest().entries;
  laboratory.key_seed = 2;
  std::filesystem::remove_all(laboratory.pack());
  static_cast<void>(laboratory.prepare());
  const engine::Pack pack(laboratory.pack());
  for (const engine::PackEntry& entry : pack.manifest().entries) {
    for (const engine::PackEntry& before : tags) CHECK(entry.input_tag != before.input_tag);
  }
}

TEST_CASE("the pack of another key is not overwritten, unless it is simulated") {
  Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  laboratory.key_seed = 2;
  CHECK(refuses<FileError>([&] { return laboratory.prepare(); }, laboratory.pack().string()));
  laboratory.simulated = true;
  CHECK(reused(laboratory.prepare()) == 0);
  CHECK(engine::Pack(laboratory.pack()).manifest().study_id == laboratory.key().study_id);
  CHECK(laboratory.files().size() == 3 + 2);
}

TEST_CASE("an image that is missing or cannot be decoded is named by its place in the study") {
  Laboratory laboratory;
  laboratory.document["classes"][2]["images"].push_back("absent.png");
  const auto what = message_of<StudyError>([&] { return laboratory.prepare(); });
  CHECK(what.find("study.json: /classes/2/images/1: ") == 0);
  CHECK(what.find((laboratory.folder.path() / "absent.png").string()) != std::string::npos);
  replace_file(laboratory.image(1), std::string("not an image"));
  laboratory.document["classes"].erase(2);
  CHECK(refuses<StudyError>([&] { return laboratory.prepare(); },
                            "study.json: /classes/1/images/0: "));
}

TEST_CASE("two prepares of one pack do not run at once") {
  const Laboratory laboratory;
  static_cast<void>(laboratory.prepare());
  {
    const study::PackLock lock(laboratory.pack());
    CHECK(refuses<FileError>([&] { return laboratory.prepare(); }, laboratory.pack().string()));
  }
  CHECK(reused(laboratory.prepare()) == 3);
}

TEST_CASE("a lock may be waited for, readers share it, and a folder that stays empty goes") {
  using Lock = study::PackLock;
  const Laboratory laboratory;
  {
    const Lock other(laboratory.pack());
    CHECK_THROWS_AS(Lock(laboratory.pack(), Lock::Use::read), FileError);
  }
  CHECK_FALSE(std::filesystem::exists(laboratory.pack()));
  CHECK_NOTHROW(Lock(laboratory.pack(), Lock::Use::read));
  static_cast<void>(laboratory.prepare());
  std::optional<Lock> reading(std::in_place, laboratory.pack(), Lock::Use::read);
  CHECK_NOTHROW(Lock(laboratory.pack(), Lock::Use::read));
  CHECK_THROWS_AS(Lock(laboratory.pack()), FileError);
  std::atomic<bool> is_free{false};
  auto waiting = std::async(std::launch::async, [&] {
    const Lock lock(laboratory.pack(), Lock::Use::prepare, Lock::Wait::yes);
    return is_free.load();
  });
  is_free = true;
  reading.reset();
  CHECK(waiting.get());
}

TEST_CASE("a file in the place of the pack is refused") {
  const Laboratory laboratory;
  replace_file(laboratory.pack(), std::string("a file"));
  CHECK_THROWS_AS(laboratory.prepare(), FileError);
}

TEST_CASE("a classification skips the methods that it does not present, and says so") {
  Laboratory laboratory;
  laboratory.document["methods"].push_back({{"name", "tv-gabor"}});
  const study::PrepareReport report = laboratory.prepare();
  CHECK(report.stimuli.size() == 3);
  REQUIRE(report.skipped.size() == 1);
  CHECK_THAT(report.skipped[0].what, names("tv-gabor 3"));
  CHECK_THAT(report.skipped[0].why, names("adaptive"));
}

TEST_CASE("a comparison prepares every method, and equalised, all have the same rms force") {
  Laboratory laboratory;
  laboratory.document["protocol"] = "comparison";
  laboratory.document["methods"] = {{{"name", "adaptive"}}, {{"name", "tv-gabor"}}};
  laboratory.document["rendering"] = {{"equalise", "rms"}};
  const study::PrepareReport report = laboratory.prepare();
  REQUIRE(report.stimuli.size() == 6);
  CHECK(report.stimuli[0].method == "adaptive");
  CHECK(report.stimuli[1].method == "tv-gabor");
  for (const study::PreparedStimulus& prepared : report.stimuli) {
    CHECK(prepared.statistics.tangential_rms_n ==
          Approx(report.stimuli[0].statistics.tangential_rms_n).epsilon(1e-5));
  }
  CHECK(report.stimuli[0].gains.tangential_n != report.stimuli[1].gains.tangential_n);
}

TEST_CASE("settings that are probably mistakes cause a warning where they have an effect") {
  Laboratory laboratory;
  laboratory.document["rendering"] = {{"model", "surface"}, {"reference_grey", 0}};
  CHECK(laboratory.prepare().warnings.empty());
  laboratory.document["rendering"] = {{"gains", {{"tangential_n", 5}, {"normal_n", 5}}},
                                      {"equalise", "rms"},
                                      {"reference_grey", 0}};
  laboratory.document["classes"][0]["label"] = "\xd1\x81\xd0\xbe\xd1\x81\xd0\xbd\xd0\xb0";
  std::filesystem::copy_file(laboratory.image(0), laboratory.image(2),
                             std::filesystem::copy_options::overwrite_existing);
  engine::write_png(laboratory.image(1), GreyImage(kSide, kSide, 90));
  const study::PrepareReport report = laboratory.prepare();
  CHECK(warns(report, "/rendering/gains 0.4"));
  CHECK(warns(report, "/rendering/equalise"));
  CHECK(warns(report, "/rendering/reference_grey 0"));
  CHECK(warns(report, "c2 c2_0.png"));
  CHECK(warns(report, "/classes c1 1"));
  CHECK(warns(report, "c1 c1_0.png adaptive"));
  CHECK(report.warnings.size() == 6);
}

TEST_CASE(
    "a validity rule that no trial can meet causes a warning, and can be set to one that can") {
  Laboratory laboratory;
  laboratory.document["trials"]["explore_limit_s"] = 1.5;
  const study::PrepareReport report = laboratory.prepare();
  CHECK(warns(report, "/trials/validity/exploring_s 5 s"));
  CHECK(warns(report, "/trials/validity/contact_s 5 s"));
  CHECK(warns(report, "/trials/validity/path_mm 300 mm"));
  CHECK(report.warnings.size() == 3);
  laboratory.document["trials"]["validity"] = {
      {"exploring_s", 1.5}, {"contact_s", 1}, {"path_mm", 100}};
  CHECK(laboratory.prepare().warnings.empty());
  laboratory.document["trials"]["validity"]["least_median_n"] = 3;
  CHECK(warns(laboratory.prepare(), "/trials/validity/least_median_n 3 N 2 N"));
}

TEST_CASE("gains that leave nothing to feel cause a warning, unless they were requested") {
  Laboratory laboratory;
  for (std::uint64_t c = 0; c < 3; ++c) engine::write_png(laboratory.image(c), GreyImage(1, 7, 50));
  const std::size_t flat = laboratory.prepare().warnings.size();
  laboratory.document["rendering"]["gains"] = {{"tangential_n", 0}, {"normal_n", 0}};
  CHECK(laboratory.prepare().warnings.size() < flat);
}

TEST_CASE("a solver that gives up causes a warning with the gap that it reached") {
  Laboratory laboratory;
  laboratory.document["methods"] = {{{"name", "tv-gabor"}, {"max_steps", 1}, {"gap", 1e-12}}};
  const study::PrepareReport report = laboratory.prepare();
  CHECK(report.warnings.size() == 3);
  CHECK(warns(report, "tv-gabor 1"));
}

TEST_CASE("the field of a flat image is what an extraction would give") {
  Laboratory laboratory;
  for (std::uint64_t c = 0; c < 3; ++c)
    engine::write_png(laboratory.image(c), GreyImage(kSide, kSide, 90));
  for (const char* method : {"adaptive", "luminance", "tv-gabor"}) {
    INFO(method);
    laboratory.document["methods"] = {{{"name", method}}};
    static_cast<void>(laboratory.prepare());
    const study::StudyKey key = laboratory.key();
    check_field(laboratory, key.study.methods[0], 0, key.stimuli[0].code);
  }
}

TEST_CASE("a method's control is made of its texture, and differs by image") {
  Laboratory laboratory;
  std::filesystem::copy_file(laboratory.image(0), laboratory.image(2),
                             std::filesystem::copy_options::overwrite_existing);
  laboratory.document["protocol"] = "comparison";
  laboratory.document["methods"] = {{{"name", "adaptive"}},
                                    {{"name", "adaptive"}, {"control", "phase-scrambled"}}};
  static_cast<void>(laboratory.prepare());
  const study::StudyKey key = laboratory.key();
  check_field(laboratory, study::method_of(key.study, {0, 0, 1}), 0, key.code_of({0, 0, 1}));
  const engine::Pack pack(laboratory.pack());
  CHECK(pack.entry(key.code_of({0, 0, 1})).checksum != pack.entry(key.code_of({2, 0, 1})).checksum);
  CHECK(pack.entry(key.code_of({0, 0, 0})).checksum == pack.entry(key.code_of({2, 0, 0})).checksum);
  const study::PrepareReport again = laboratory.prepare();
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
  const study::PrepareReport report = study::prepare_pack(laboratory.key(), laboratory.pack(),
                                                          [&](int count, int) { done = count; },
                                                          {.large_image_px = kSide * kSide - 1});
  CHECK(laboratory.files() == whole);
  CHECK(done == 3);
  CHECK(reused(report) == 0);
  CHECK(report.stimuli[0].statistics.tangential_rms_n > 0.0);
}

TEST_CASE("progress counts every stimulus once, and statistics are computed only if asked for") {
  const Laboratory laboratory;
  std::vector<int> counts;
  int total = 0;
  const auto progress = [&](int done, int of) {
    counts.push_back(done);
    total = of;
  };
  const study::PrepareReport report =
      study::prepare_pack(laboratory.key(), laboratory.pack(), progress, {.statistics = false});
  CHECK(report.stimuli[0].statistics.tangential_rms_n == 0.0);
  CHECK(counts == std::vector<int>{1, 2, 3});
  CHECK(total == 3);
}

}  // namespace touchtrial
