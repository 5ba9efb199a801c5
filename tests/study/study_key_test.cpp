#include "study/study_key.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/study_examples.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <set>

#include <sys/stat.h>

namespace touchtrial {
namespace {

using namespace study;
using nlohmann::json;

StudyKey key_for(const json& document, std::uint64_t seed = 1, bool simulated = false) {
  SeededEntropy entropy(seed);
  return study::make_study_key(parsed(document, "/studies"), entropy, simulated);
}

std::string code_of_image(const StudyKey& key, const std::string& image, int method = 0) {
  for (const auto& [code, stimulus] : key.stimuli) {
    const auto& images = key.study.classes[static_cast<std::size_t>(stimulus.class_index)].images;
    const bool wanted = images[static_cast<std::size_t>(stimulus.exemplar)] == image;
    if (wanted && stimulus.method == method) return code;
  }
  return "no stimulus";
}

bool is_hex(const std::string& text, std::size_t digits) {
  return text.size() == digits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

TEST_CASE("a key names every presented stimulus with a code of its own") {
  const StudyKey key = key_for(comparison_of(3, 4));
  REQUIRE(key.stimuli.size() == 3 * 4 * 2);
  std::set<std::string> codes;
  for (const auto& [code, stimulus] : key.stimuli) {
    CHECK(is_hex(code, 16));
    codes.insert(code);
    CHECK(key.stimulus_of(code) == stimulus);
    CHECK(key.code_of(stimulus) == code);
  }
  CHECK(codes.size() == key.stimuli.size());
  CHECK(is_hex(key.study_id, 32));
}

TEST_CASE("a key knows no code and no stimulus that its study does not present") {
  json document = comparison_of(3);
  document["protocol"] = "classification";
  const StudyKey key = key_for(document);
  CHECK(key.stimuli.size() == 3);
  CHECK_FALSE(key.stimulus_of("0123456789abcdef").has_value());
  CHECK_THROWS_AS(key.code_of({0, 0, 1}), StudyError);
  CHECK_THROWS_AS(key.code_of({3, 0, 0}), StudyError);
}

TEST_CASE("secrets decide codes and identity: two keys of one study share none") {
  const StudyKey one = key_for(study_of(5), 1);
  const StudyKey other = key_for(study_of(5), 2);
  CHECK(one.study_id != other.study_id);
  std::set<std::string> codes;
  for (const StudyKey* key : {&one, &other}) {
    for (const KeyedStimulus& stimulus : key->stimuli) codes.insert(stimulus.code);
  }
  CHECK(codes.size() == 10);
  SystemEntropy entropy;
  const Study study = parsed(study_of(5));
  CHECK(study::make_study_key(study, entropy, false).master !=
        study::make_study_key(study, entropy, false).master);
}

TEST_CASE("codes stay with their stimuli when others come and go") {
  json document = study_of(3, 2);
  const StudyKey before = key_for(document);
  document["classes"].erase(0);
  document["classes"].push_back({{"label", "new"}, {"images", {"new.png"}}});
  document["rendering"] = {{"pitch_mm", 0.1}};
  const StudyKey after = rekeyed(before, parsed(document));
  CHECK(after.study_id == before.study_id);
  CHECK(after.master == before.master);
  for (const char* image : {"c1_0.png", "c1_1.png", "c2_0.png"}) {
    CHECK(code_of_image(after, image) == code_of_image(before, image));
    CHECK(is_hex(code_of_image(after, image), 16));
  }
  CHECK_FALSE(before.stimulus_of(code_of_image(after, "new.png")).has_value());
}

TEST_CASE("a code depends on label, image and method, with no way to shift text between them") {
  json document = minimal_study();
  document["classes"][0] = {{"label", "a|b"}, {"images", {"c"}}};
  const std::string one = key_for(document).stimuli[0].code;
  document["classes"][0] = {{"label", "a"}, {"images", {"b|c"}}};
  const std::string other = key_for(document).stimuli[0].code;
  document["methods"] = {{{"name", "fixed"}}};
  const std::string third = key_for(document).stimuli[0].code;
  CHECK(std::set<std::string>{one, other, third}.size() == 3);
}

TEST_CASE("a saved key is for its owner's eyes and comes back whole") {
  const TempFolder folder;
  const auto path = folder.path() / "small.key";
  SeededEntropy entropy(5);
  const Study study = study::parse_study(comparison_of(3, 2).dump(1), folder.path(), "study.json");
  StudyKey key = study::make_study_key(study, entropy, true);
  key.pack_folder = folder.path() / "small.pack";
  study::save_study_key(path, key);
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == 0600U);

  const StudyKey loaded = load_study_key(path);
  CHECK(loaded.study_id == key.study_id);
  CHECK(loaded.master == key.master);
  CHECK(loaded.simulated);
  CHECK(loaded.study.text == key.study.text);
  const auto same = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    return std::filesystem::weakly_canonical(a) == std::filesystem::weakly_canonical(b);
  };
  CHECK(same(loaded.study.folder, folder.path()));
  CHECK(same(loaded.pack_folder, key.pack_folder));
  CHECK(study::study_seal(loaded) == study::study_seal(key));
  REQUIRE(loaded.stimuli.size() == key.stimuli.size());
  for (std::size_t i = 0; i < key.stimuli.size(); ++i) {
    CHECK(loaded.stimuli[i].code == key.stimuli[i].code);
    CHECK(loaded.stimuli[i].stimulus == key.stimuli[i].stimulus);
  }
}

TEST_CASE("a key moved together with its study and pack finds them at the new place") {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path() / "old");
  StudyKey key = key_for(minimal_study());
  key.study.folder = folder.path() / "old";
  key.pack_folder = folder.path() / "old" / "small.pack";
  study::save_study_key(folder.path() / "old" / "small.key", key);
  std::filesystem::rename(folder.path() / "old", folder.path() / "new");
  const StudyKey moved = load_study_key(folder.path() / "new" / "small.key");
  CHECK(moved.pack_folder == std::filesystem::canonical(folder.path()) / "new" / "small.pack");
  CHECK(moved.study.folder == std::filesystem::canonical(folder.path()) / "new");
}

TEST_CASE("a file that is no key, and a key of another version, are told apart from damage") {
  const TempFolder folder;
  const auto path = folder.path() / "small.key";
  replace_file(path, minimal_study().dump(), FileMode::owner_only);
  CHECK(refuses<FileError>([&] { return load_study_key(path); }, path.string()));
  replace_file(path, std::string(R"({"format": "touchtrial-key", "version": 2})"),
               FileMode::owner_only);
  CHECK(refuses<FileError>([&] { return load_study_key(path); }, path.string() + " 2 3"));
  CHECK(refuses<FileError>([&] { return load_study_key(folder.path() / "none.key"); }, "none.key"));
}

TEST_CASE("a schedule comes back from its secret text") {
  json document = comparison_of(3, 2);
  document["trials"] = {{"lead_in", 1}};
  const StudyKey key = key_for(document);
  const Schedule schedule = study::make_schedule(key.study, key.draw_of(4, Draws::people));
  const std::string text = schedule_to_json(schedule, key);
  CHECK(schedule_from_json(text, key) == schedule);
  CHECK(text.find("label") == std::string::npos);
  CHECK(text.find(".png") == std::string::npos);
  CHECK(text.find('\n') == std::string::npos);
}

TEST_CASE("a schedule of another key, or of another form, is refused") {
  const StudyKey key = key_for(study_of(3));
  const std::string text =
      schedule_to_json(study::make_schedule(key.study, key.draw_of(1, Draws::people)), key);
  CHECK_THROWS_AS(schedule_from_json(text, key_for(study_of(3), 2)), StoreError);
  CHECK_THROWS_AS(schedule_from_json("", key), StoreError);
  CHECK_THROWS_AS(schedule_from_json("[]", key), StoreError);
  CHECK_THROWS_AS(schedule_from_json("{\"presentations\":1,\"layout\":[]}", key), StoreError);
  json altered = json::parse(text);
  altered["layout"][1] = altered["layout"][0];
  CHECK_THROWS_AS(schedule_from_json(altered.dump(), key), StoreError);
  altered = json::parse(text);
  altered["presentations"][0]["kind"] = "other";
  CHECK_THROWS_AS(schedule_from_json(altered.dump(), key), StoreError);
}

}  // namespace touchtrial
