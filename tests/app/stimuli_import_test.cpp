// A user's photographs, from their folder to an accuracy table and a contact sheet.
#include "app/study_folder.hpp"
#include "engine/image_samples.hpp"
#include "support/catch.hpp"

#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

/// Noisy stripes whose width and direction depend on the number.
GreyImage photograph(int number) {
  RandomStream random(5, "import application test", static_cast<std::uint64_t>(number));
  GreyImage image(130, 170);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const int place = number % 2 == 0 ? x : y;
      const int stripes = 120 * ((place / (4 + 3 * number)) % 2);
      image.at(y, x) = static_cast<std::uint8_t>(40 + stripes + static_cast<int>(random.below(60)));
    }
  }
  return image;
}

struct Album : ProgramFolder {
  Album() {
    fs::create_directory(folder.path() / "album");
    write_png(folder.path() / "album" / "D1.png", photograph(1));
    write_png(folder.path() / "album" / "D2.png", photograph(2));
  }
  [[nodiscard]] ProgramResult import_with(const std::vector<std::string>& more) const {
    return type("stimuli import @album --study @mine.json --size 60 --crops 2", more);
  }
  [[nodiscard]] ProgramResult sheet(const std::string& output,
                                    const std::vector<std::string>& more = {}) const {
    return type("stimuli sheet @mine.json -o @" + output, more);
  }
};

}  // namespace

TEST_CASE("imported photographs make a study that prepares, simulates and reports unedited") {
  for (const std::string protocol : {"classification", "comparison"}) {
    const Album album;
    const ProgramResult imported =
        succeeded(album.import_with({"--protocol", protocol, "--equalise", "both", "--json"}));
    const json summary = json::parse(imported.output);
    CHECK(summary.at("classes").size() == 2);
    CHECK(summary.at("classes")[0].at("crops") == 2);
    album.done("prepare @mine.json");
    album.done("simulate @mine.json --participants 2 --seed 1 --db @mine.db");
    const ProgramResult reported = album.done("report @mine.db --json");
    CHECK(json::parse(reported.output).at("classes") == json::array({"D1", "D2"}));
  }
}

TEST_CASE("import prints a summary, and refuses invalid arguments") {
  const Album album;
  const ProgramResult made = succeeded(album.import_with({"--licence", "CC0-1.0"}));
  CHECK_THAT(made.output, holds_text("CC0-1.0"));
  CHECK_THAT(made.output, holds_text("12 x 12 mm"));
  check_refused(album.import_with({}), 2, {"mine.json"});
  check_refused(album.import_with({"--pixels-per-mm", "many"}), 2, {"--pixels-per-mm"});
  check_refused(album.import_with({"--equalise", "most"}), 2, {"most"});
  const ProgramResult many =
      album.type("stimuli import @album --study @other.json --size 60 --crops 90");
  CHECK(many.exit_code == 1);
  CHECK_THAT(many.errors, holds_text("album: has 2 faults; give --crops 12, --size"));
}

TEST_CASE("a contact sheet shows every code, and only its owner can read it") {
  const Album album;
  succeeded(album.import_with({}));
  album.done("prepare @mine.json");
  CHECK_THAT(succeeded(album.sheet("sheet.html")).output, holds_text("unblinds"));
  const auto others = fs::perms::group_all | fs::perms::others_all;
  CHECK((fs::status(album.in("sheet.html")).permissions() & others) == fs::perms::none);
  const std::string html = text_of(read_file(album.in("sheet.html")));
  const json key = json::parse(text_of(read_file(album.in("mine.key"))));
  for (const json& stimulus : key.at("stimuli")) {
    CHECK_THAT(html, holds_text(stimulus.at("code").get<std::string>()));
  }
  CHECK_THAT(html, holds_text("unblind"));
  CHECK_THAT(html, !holds_text("Of the pictures"));
  CHECK_THAT(html, holds_text("D2, 2 of 2") && holds_text("data:image/png;base64,"));
}

TEST_CASE("remarks of prepare on a picture are repeated, and shown in the contact sheet") {
  const Album album;
  succeeded(album.import_with({}));
  Bytes pixels;
  for (int i = 0; i < 60 * 60; ++i) pixels.push_back(static_cast<std::uint8_t>(i % 251));
  replace_file(album.in("mine.pictures/D2-1.png"),
               samples::Tiff(60, 60, pixels).with(274, {6}).bytes());
  for (int time = 0; time < 2; ++time) {
    CHECK_THAT(album.done("prepare @mine.json").errors, holds_text("D2-1.png"));
  }
  succeeded(album.sheet("sheet.html"));
  CHECK_THAT(text_of(read_file(album.in("sheet.html"))), holds_text("mine.pictures/D2-1.png"));
}

TEST_CASE("a contact sheet is drawn with a key that is kept elsewhere") {
  const Album album;
  succeeded(album.import_with({}));
  album.done("prepare @mine.json");
  fs::create_directories(album.in("drawer/stick"));
  fs::rename(album.in("mine.key"), album.in("drawer/stick/away.key"));
  check_refused(album.sheet("sheet.html"), 1, {});
  succeeded(album.sheet("sheet.html", {"--key", album.in("drawer/stick/away.key")}));
  CHECK(path_exists(album.in("sheet.html")));
}

TEST_CASE("the table of an import says when its levels are those before equalising") {
  const Album album;
  const ProgramResult plain = succeeded(album.import_with({}));
  const ProgramResult equal = succeeded(album.import_with({"--force", "--equalise", "both"}));
  CHECK(equal.output.size() > plain.output.size());
}

TEST_CASE("without its key, or with another study's key, there is no sheet") {
  const Album album;
  succeeded(album.import_with({}));
  check_refused(album.sheet("sheet.html"), 1, {});
  album.done("prepare @mine.json");
  check_refused(album.sheet("sheet.html", {"--key", album.in("other.key")}), 1, {"other.key"});
  check_refused(album.sheet("sheet.svg"), 2, {"sheet.svg", ".html"});
  write_png(album.in("mine.pictures/D1-1.png"), photograph(3));
  check_refused(album.sheet("sheet.html"), 3, {});
  succeeded(album.import_with({"--force", "--seed", "2"}));
  check_refused(album.sheet("sheet.html"), 3, {});
  CHECK_FALSE(path_exists(album.in("sheet.html")));
}
