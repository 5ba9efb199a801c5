#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::engine;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

void write_stripes(const fs::path& path, int period) {
  GreyImage image(48, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      image.at(y, x) = static_cast<std::uint8_t>((x / period) % 2 == 0 ? 60 : 180);
    }
  }
  make_folder(path.parent_path());
  write_png(path, image);
}

}  // namespace

TEST_CASE("measure takes a study, a picture and a folder of photographs, each a set of its own") {
  const TempFolder folder;
  const auto in = [&](const char* name) { return (folder.path() / name).string(); };
  write_stripes(folder.path() / "wide.png", 8);
  write_stripes(folder.path() / "narrow.png", 3);
  write_stripes(folder.path() / "photographs" / "slate.png", 5);
  write_stripes(folder.path() / "photographs" / "denim" / "1.png", 4);
  write_stripes(folder.path() / "photographs" / "denim" / "2.PNG", 6);
  replace_file(folder.path() / "photographs" / "notes.txt", "none");
  replace_file(folder.path() / "study.json", R"({"study": "stripes", "protocol": "classification",
    "classes": [{"label": "a", "images": ["wide.png"]}, {"label": "b", "images": ["narrow.png"]}],
    "methods": [{"name": "adaptive"}], "seed": 1})");
  const ProgramResult result =
      run_touchtrial(folder.path(), {"stimuli", "measure", in("study.json"), in("wide.png"),
                                     "--photographs", in("photographs"), "--json"});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  const json measured = json::parse(result.output);
  REQUIRE(measured.at("sets").size() == 3);
  CHECK(measured.at("sets")[0].at("set") == "stripes");
  CHECK(measured.at("sets")[1].at("set") == "pictures");
  CHECK(measured.at("sets")[2].at("set") == "photographs");
  CHECK(measured.at("sets")[2].at("classes") == 2);
  CHECK(measured.at("sets")[2].at("pictures") == 3);
  const ProgramResult text = run_touchtrial(folder.path(), {"stimuli", "measure", in("wide.png")});
  CHECK(text.exit_code == 0);
  CHECK_THAT(text.output, holds_text("wide.png"));
}

TEST_CASE("measure refuses in one line what is not a picture, too small, missing or empty") {
  const TempFolder folder;
  write_png(folder.path() / "tiny.png", GreyImage(20, 20, 7));
  replace_file(folder.path() / "text.png", "no picture");
  make_folder(folder.path() / "empty");
  const auto refusal = [&](const std::string& input) {
    const ProgramResult result =
        run_touchtrial(folder.path(), {"stimuli", "measure", (folder.path() / input).string()});
    CHECK(result.exit_code != 0);
    CHECK(result.output.empty());
    return result.errors;
  };
  CHECK_THAT(refusal("tiny.png"), holds_text("tiny.png") && holds_text("32 px"));
  CHECK_THAT(refusal("text.png"), holds_text("text.png"));
  CHECK_THAT(refusal("empty"), holds_text("contains no picture"));
  CHECK_THAT(refusal("none.png"), holds_text("none.png"));
}
