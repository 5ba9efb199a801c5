#include "protocols/design/prepare_notes.hpp"

#include "core/files.hpp"
#include "protocols/design/laboratory.hpp"
#include "protocols/design/private_notes.hpp"
#include "support/catch.hpp"

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using namespace std::chrono_literals;

constexpr const char* kNotRead = "same size and time as last time: not read";
constexpr const char* kByTime =
    "same picture and options, and intact by size and time: nothing was extracted";
constexpr const char* kByHash =
    "same picture and options, and intact by its hash: nothing was extracted";

/// A laboratory with notes, which trusts files as soon as they are written.
struct NotedLaboratory : Laboratory {
  std::chrono::nanoseconds settled_after = 0s;

  [[nodiscard]] std::filesystem::path notes() const { return folder.path() / "notes"; }
  [[nodiscard]] design::PrepareReport prepare() const {
    return design::prepare_pack(
        key(), pack(), {}, {.explain = true, .notes = notes(), .settled_after = settled_after});
  }
  [[nodiscard]] std::filesystem::path field(std::size_t i) const {
    return pack() / (key().stimuli[i].code + ".field");
  }
};

std::string why(const std::vector<engine::Stage>& stages, const std::string& name) {
  const auto found = std::ranges::find(stages, name, &engine::Stage::name);
  return found == stages.end() ? "" : found->why;
}

void write_in_place(const std::filesystem::path& path, const Bytes& content) {
  std::ofstream file(path, std::ios::binary | std::ios::in);
  file.write(reinterpret_cast<const char*>(content.data()),
             static_cast<std::streamsize>(content.size()));
}

void require_same_results(const design::PrepareReport& one, const design::PrepareReport& other) {
  REQUIRE(one.stimuli.size() == other.stimuli.size());
  for (std::size_t i = 0; i < one.stimuli.size(); ++i) {
    const auto& [a, b] = std::pair(one.stimuli[i], other.stimuli[i]);
    CHECK(a.class_label == b.class_label);
    CHECK(a.gains == b.gains);
    CHECK(a.bytes == b.bytes);
    CHECK(a.statistics.tangential_rms_n == b.statistics.tangential_rms_n);
    CHECK(a.statistics.tangential_p999_n == b.statistics.tangential_p999_n);
    CHECK(a.statistics.normal_rms_n == b.statistics.normal_rms_n);
    CHECK(a.statistics.stiffness_p99_n_per_mm == b.statistics.stiffness_p99_n_per_mm);
    CHECK(a.statistics.share_below_1_mm == b.statistics.share_below_1_mm);
    CHECK(a.statistics.share_above_250_hz == b.statistics.share_above_250_hz);
  }
  CHECK(one.warnings == other.warnings);
}

}  // namespace

TEST_CASE(
    "with notes, what is unchanged is neither read nor measured, and the report is the same") {
  NotedLaboratory laboratory;
  engine::write_png(laboratory.image(1), GreyImage(kSide, kSide, 90));  // a warning: flat
  const design::PrepareReport first = laboratory.prepare();
  const auto files = laboratory.files();
  const design::PrepareReport again = laboratory.prepare();
  CHECK(reused(again) == 3);
  for (const design::PreparedStimulus& stimulus : again.stimuli) {
    CHECK(why(stimulus.stages, "read image") == kNotRead);
    CHECK(why(stimulus.stages, "field") == kByTime);
    CHECK(why(stimulus.stages, "statistics") == "same fields and study as last time");
  }
  CHECK(why(again.study_stages, "gains") == "same fields and study as last time");
  require_same_results(first, again);
  CHECK(laboratory.files() == files);
  const auto noted = std::filesystem::last_write_time(
      std::filesystem::directory_iterator(laboratory.notes())->path());
  static_cast<void>(laboratory.prepare());
  CHECK(std::filesystem::last_write_time(
            std::filesystem::directory_iterator(laboratory.notes())->path()) == noted);
}

TEST_CASE("a picture that was only touched is read again, and its field is reused") {
  const NotedLaboratory laboratory;
  static_cast<void>(laboratory.prepare());
  std::filesystem::last_write_time(laboratory.image(1),
                                   std::filesystem::last_write_time(laboratory.image(1)) - 1h);
  const design::PrepareReport touched = laboratory.prepare();
  CHECK(reused(touched) == 3);
  CHECK(why(touched.stimuli[0].stages, "read image") == kNotRead);
  CHECK(why(touched.stimuli[1].stages, "read image") ==
        "not the size and time of last time: its pixels decide what must be built");
  CHECK(why(touched.stimuli[1].stages, "field") == kByTime);
  CHECK(why(laboratory.prepare().stimuli[1].stages, "read image") == kNotRead);
}

TEST_CASE(
    "a picture that changed is built anew, though size and time of its content are the same") {
  NotedLaboratory laboratory;
  const bool settled = GENERATE(true, false);
  if (!settled) laboratory.settled_after = 1h;
  static_cast<void>(laboratory.prepare());
  const auto time = std::filesystem::last_write_time(laboratory.image(1));
  const auto bytes = std::filesystem::file_size(laboratory.image(1));
  // Another picture whose file is as long.
  std::uint64_t seed = 77;
  do {
    write_noise(laboratory.image(1), seed++);
  } while (std::filesystem::file_size(laboratory.image(1)) != bytes);
  std::filesystem::last_write_time(laboratory.image(1), time);
  const design::PrepareReport changed = laboratory.prepare();
  CHECK(reused(changed) == 2);
  CHECK_FALSE(changed.stimuli[1].reused);
  CHECK(why(changed.stimuli[1].stages, "read image") ==
        "not the size and time of last time: its pixels decide what must be built");
}

TEST_CASE("files that changed shortly before they were noted are known by their content") {
  NotedLaboratory laboratory;
  laboratory.settled_after = 1h;
  static_cast<void>(laboratory.prepare());
  const design::PrepareReport again = laboratory.prepare();
  CHECK(reused(again) == 3);
  CHECK(again.stimuli[0].stages[0].state == engine::StageState::computed);
  CHECK(why(again.stimuli[0].stages, "field") == kByHash);
  CHECK(why(again.stimuli[0].stages, "statistics") == "same fields and study as last time");
}

TEST_CASE(
    "a damaged field is built anew, though its size and the time of its content are the same") {
  NotedLaboratory laboratory;
  const bool settled = GENERATE(true, false);
  if (!settled) laboratory.settled_after = 1h;
  static_cast<void>(laboratory.prepare());
  const auto files = laboratory.files();
  const auto time = std::filesystem::last_write_time(laboratory.field(0));
  Bytes content = read_file(laboratory.field(0));
  content[content.size() / 2] ^= 1U;
  write_in_place(laboratory.field(0), content);
  std::filesystem::last_write_time(laboratory.field(0), time);
  std::filesystem::remove(laboratory.field(2));
  const design::PrepareReport report = laboratory.prepare();
  CHECK(reused(report) == 1);
  CHECK(report.stimuli[1].reused);
  CHECK(why(report.stimuli[0].stages, "write field") == "the pack's field was damaged or missing");
  CHECK(laboratory.files() == files);
}

TEST_CASE("without its notes, or with damaged or foreign ones, a study is known by its content") {
  NotedLaboratory laboratory;
  const design::PrepareReport first = laboratory.prepare();
  const auto note = std::filesystem::directory_iterator(laboratory.notes())->path();
  SECTION("removed") {
    std::filesystem::remove_all(laboratory.notes());
  }
  SECTION("damaged") {
    Bytes content = read_file(note);
    content[content.size() / 2] ^= 1U;
    replace_file(note, ByteView(content));
  }
  SECTION("another key's") {
    NotedLaboratory other;
    other.key_seed = 2;
    static_cast<void>(other.prepare());
    std::filesystem::copy_file(std::filesystem::directory_iterator(other.notes())->path(), note,
                               std::filesystem::copy_options::overwrite_existing);
  }
  const design::PrepareReport again = laboratory.prepare();
  CHECK(reused(again) == 3);
  CHECK(why(again.stimuli[0].stages, "field") == kByHash);
  CHECK(why(again.stimuli[0].stages, "statistics") == "they follow the gains of the study");
  require_same_results(first, again);
  CHECK(why(laboratory.prepare().stimuli[0].stages, "field") == kByTime);
}

TEST_CASE("with notes, other options, gains or pictures are what they would be without") {
  NotedLaboratory laboratory;
  static_cast<void>(laboratory.prepare());
  SECTION("stiffness") {
    laboratory.document["rendering"] = {{"texture_stiffness_n_per_mm", 0.2}};
  }
  SECTION("method") {
    laboratory.document["methods"][0]["radius"] = 3;
  }
  SECTION("rendering") {
    laboratory.document["rendering"] = {{"filter_mm", 0.3}};
  }
  SECTION("a class less") {
    laboratory.document["classes"].erase(2);
  }
  SECTION("exchanged pictures") {
    const auto aside = laboratory.folder.path() / "aside";
    std::filesystem::rename(laboratory.image(0), aside);
    std::filesystem::rename(laboratory.image(1), laboratory.image(0));
    std::filesystem::rename(aside, laboratory.image(1));
  }
  const design::PrepareReport noted = laboratory.prepare();
  const auto files = laboratory.files();
  std::filesystem::remove_all(laboratory.pack());
  const design::PrepareReport fresh = laboratory.Laboratory::prepare();
  require_same_results(noted, fresh);
  CHECK(laboratory.files() == files);
}

TEST_CASE("statistics that were not asked for at first are computed when they are") {
  const NotedLaboratory laboratory;
  design::PrepareOptions options{
      .statistics = false, .notes = laboratory.notes(), .settled_after = 0s};
  static_cast<void>(design::prepare_pack(laboratory.key(), laboratory.pack(), {}, options));
  options.statistics = true;
  const auto report = design::prepare_pack(laboratory.key(), laboratory.pack(), {}, options);
  CHECK(report.stimuli[0].statistics.tangential_rms_n > 0.0);
}

TEST_CASE("notes show nothing of what they say, and none are kept without a folder") {
  const NotedLaboratory laboratory;
  static_cast<void>(laboratory.prepare());
  for (const auto& file : std::filesystem::directory_iterator(laboratory.notes())) {
    const std::string text = text_of(read_file(file.path()));
    CHECK(text.find("c0_0") == std::string::npos);
    for (const design::KeyedStimulus& stimulus : laboratory.key().stimuli) {
      CHECK(text.find(stimulus.code) == std::string::npos);
    }
  }
  const design::PrivateNotes none({}, laboratory.key().master, "prepare");
  none.keep("something");
  CHECK_FALSE(none.read());
}

TEST_CASE("notes on one subject are not those on another") {
  const TempFolder folder;
  const SecretKey master{1, 2, 3};
  const design::PrivateNotes one(folder.path() / "new", master, "one");
  const design::PrivateNotes two(folder.path() / "new", master, "two");
  one.keep("first");
  CHECK_FALSE(two.read());
  one.keep("again");
  two.keep("second");
  CHECK(one.read() == "again");
  CHECK(two.read() == "second");
}

TEST_CASE("notes that were not written for 90 days are removed when others are kept") {
  const TempFolder folder;
  const design::PrivateNotes one(folder.path(), SecretKey{1}, "one");
  const design::PrivateNotes two(folder.path(), SecretKey{2}, "two");
  one.keep("first");
  const auto file = *std::filesystem::directory_iterator(folder.path());
  const std::filesystem::path draft = file.path().string() + ".tmp17";
  const std::filesystem::path other = folder.path() / "other";
  std::filesystem::copy_file(file, draft);
  std::filesystem::copy_file(file, other);
  const auto let_age = [&](std::chrono::hours age) {
    const auto written = std::filesystem::file_time_type::clock::now() - age;
    for (const auto& path : {file.path(), draft, other}) {
      std::filesystem::last_write_time(path, written);
    }
  };
  let_age(design::kKeptNotes - 1h);
  two.keep("second");
  CHECK(one.read() == "first");
  CHECK(is_there(draft));
  let_age(design::kKeptNotes + 1h);
  two.keep("third");
  CHECK_FALSE(one.read());
  CHECK_FALSE(is_there(draft));
  CHECK(is_there(other));
  CHECK(two.read() == "third");
}

TEST_CASE("notes come back from their text as they were, and other texts are no notes") {
  design::PrepareNotes notes;
  notes.pictures["/a b"] = {{1, 2, 3, -4, 5}, Digest{7}, 9};
  notes.fields["code"] = {Digest{1}, Digest{2}, Digest{3}, Digest{4}, {6, 7, 8, 9, 10}};
  notes.measured.emplace();
  notes.measured->gains.of_field = {{0.1, 1.0 / 3.0, 0.0}};
  notes.measured->flat = {1};
  notes.measured->statistics.emplace_back().share_above_250_hz[2] = 1e-17;
  const std::string text = design::text_of_notes(notes);
  const design::PrepareNotes read = design::notes_of_text(text);
  CHECK(design::text_of_notes(read) == text);
  CHECK(read.pictures.at("/a b").stamp.changed_ns == -4);
  CHECK(read.measured->gains.of_field[0] == notes.measured->gains.of_field[0]);
  CHECK(read.measured->statistics[0].share_above_250_hz[2] == 1e-17);
  for (const char* other : {"", "{}", "[1]", R"({"pictures": {"a": [1]}, "fields": {}})"}) {
    CHECK(design::notes_of_text(other).pictures.empty());
  }
}

}  // namespace touchtrial
