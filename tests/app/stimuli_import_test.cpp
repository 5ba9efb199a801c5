// A user's photographs, from their folder to an accuracy table and a contact sheet.
#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::engine;
using nlohmann::json;
namespace fs = std::filesystem;

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

struct Album {
  Album() {
    fs::create_directory(folder.path() / "album");
    write_png(folder.path() / "album" / "D1.png", photograph(1));
    write_png(folder.path() / "album" / "D2.png", photograph(2));
  }
  [[nodiscard]] std::string in(const std::string& name) const {
    return (folder.path() / name).string();
  }
  [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments) const {
    return run_touchtrial(folder.path(), arguments);
  }
  [[nodiscard]] ProgramResult import_with(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"stimuli", "import",        in("album"),
                                          "--study", in("mine.json"), "--size",
                                          "60",      "--crops",       "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] ProgramResult sheet(const std::string& output,
                                    const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"stimuli", "sheet", in("mine.json"), "-o", in(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  TempFolder folder;
};

std::string start_of(const fs::path& file, std::size_t bytes) {
  return text_of(read_file(file)).substr(0, bytes);
}

void check_refused(const ProgramResult& result, int exit_code, const std::string& reason) {
  CHECK(result.exit_code == exit_code);
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text(reason));
}

}  // namespace

TEST_CASE("imported photographs make a study that prepares, simulates and reports unedited") {
  for (const std::string protocol : {"classification", "comparison"}) {
    const Album album;
    const ProgramResult imported =
        album.import_with({"--protocol", protocol, "--equalise", "both", "--json"});
    INFO(imported.errors);
    REQUIRE(imported.exit_code == 0);
    const json summary = json::parse(imported.output);
    CHECK(summary.at("classes").size() == 2);
    CHECK(summary.at("classes")[0].at("crops") == 2);
    REQUIRE(album.run({"prepare", album.in("mine.json")}).exit_code == 0);
    const ProgramResult simulated = album.run({"simulate", album.in("mine.json"), "--participants",
                                               "2", "--seed", "1", "--db", album.in("mine.db")});
    INFO(simulated.errors);
    REQUIRE(simulated.exit_code == 0);
    const ProgramResult reported = album.run({"report", album.in("mine.db"), "--json"});
    REQUIRE(reported.exit_code == 0);
    CHECK(json::parse(reported.output).at("classes") == json::array({"D1", "D2"}));
  }
}

TEST_CASE("import says what it made, and what is wrong with its arguments") {
  const Album album;
  const ProgramResult made = album.import_with({"--licence", "CC0-1.0"});
  INFO(made.errors);
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.output, holds_text("CC0-1.0"));
  CHECK_THAT(made.output, holds_text("12 x 12 mm"));
  check_refused(album.import_with({}), 2, "mine.json exists already");
  check_refused(album.import_with({"--pixels-per-mm", "many"}), 2, "or the word file");
  check_refused(album.import_with({"--equalise", "most"}), 2, "most");
  check_refused(album.run({"stimuli", "import", album.in("album"), "--study",
                           album.in("other.json"), "--size", "60", "--crops", "90"}),
                1, "give --crops 12, --size");
}

TEST_CASE("a contact sheet is drawn as PNG, PDF and HTML that only its owner can read") {
  const Album album;
  REQUIRE(album.import_with({}).exit_code == 0);
  REQUIRE(album.run({"prepare", album.in("mine.json")}).exit_code == 0);
  for (const std::string name : {"sheet.png", "sheet.pdf", "sheet.html"}) {
    const ProgramResult drawn = album.sheet(name);
    INFO(drawn.errors);
    REQUIRE(drawn.exit_code == 0);
    CHECK_THAT(drawn.output, holds_text("unblinds"));
    const auto others = fs::perms::group_all | fs::perms::others_all;
    CHECK((fs::status(album.in(name)).permissions() & others) == fs::perms::none);
  }
  CHECK(read_grey_image(album.in("sheet.png")).width() > 1000);
  CHECK(start_of(album.in("sheet.pdf"), 5) == "%PDF-");
  const std::string html = text_of(read_file(album.in("sheet.html")));
  const json key = json::parse(text_of(read_file(album.in("mine.key"))));
  for (const json& stimulus : key.at("stimuli")) {
    CHECK_THAT(html, holds_text(stimulus.at("code").get<std::string>()));
  }
  CHECK_THAT(html, holds_text("This sheet unblinds"));
  CHECK_THAT(html, holds_text("alt=\"texture of D2, 2 of 2, adaptive, radius 2\""));
}

TEST_CASE("a contact sheet is drawn with a key that is kept elsewhere") {
  const Album album;
  REQUIRE(album.import_with({}).exit_code == 0);
  REQUIRE(album.run({"prepare", album.in("mine.json")}).exit_code == 0);
  fs::create_directories(album.in("drawer/stick"));
  fs::rename(album.in("mine.key"), album.in("drawer/stick/away.key"));
  check_refused(album.sheet("sheet.html"), 1, "there is no key, which a sheet needs");
  const ProgramResult drawn =
      album.sheet("sheet.html", {"--key", album.in("drawer/stick/away.key")});
  INFO(drawn.errors);
  CHECK(drawn.exit_code == 0);
  CHECK(is_there(album.in("sheet.html")));
}

TEST_CASE("the table of an import says when its levels are those before equalising") {
  const Album album;
  const ProgramResult plain = album.import_with({});
  REQUIRE(plain.exit_code == 0);
  CHECK(plain.output.find("before equalising") == std::string::npos);
  const ProgramResult equal = album.import_with({"--force", "--equalise", "both"});
  REQUIRE(equal.exit_code == 0);
  CHECK_THAT(equal.output, holds_text("levels   before equalising"));
}

TEST_CASE("without its key, or with another study's key, there is no sheet") {
  const Album album;
  REQUIRE(album.import_with({}).exit_code == 0);
  check_refused(album.sheet("sheet.html"), 1, "there is no key, which a sheet needs");
  REQUIRE(album.run({"prepare", album.in("mine.json")}).exit_code == 0);
  check_refused(album.sheet("sheet.html", {"--key", album.in("other.key")}), 1,
                "there is no key, which a sheet needs");
  check_refused(album.sheet("sheet.svg"), 2, "give a name that ends in .png, .pdf or .html");
  check_refused(album.sheet("mine.pictures/D1-1.png"), 2, "is an input of the sheet");
  write_png(album.in("mine.pictures/D1-1.png"), photograph(3));
  check_refused(album.sheet("sheet.html"), 3, "was not made from");
  REQUIRE(album.import_with({"--force", "--seed", "2"}).exit_code == 0);
  check_refused(album.sheet("sheet.html"), 3, "is not the key of");
  CHECK_FALSE(is_there(album.in("sheet.html")));
}
