#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::engine;

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
  const ProgramFolder folder;
  write_stripes(folder.path() / "wide.png", 8);
  write_stripes(folder.path() / "narrow.png", 3);
  write_stripes(folder.path() / "photographs" / "slate.png", 5);
  write_stripes(folder.path() / "photographs" / "denim" / "1.png", 4);
  write_stripes(folder.path() / "photographs" / "denim" / "2.PNG", 6);
  replace_file(folder.path() / "photographs" / "notes.txt", "none");
  replace_file(folder.path() / "study.json", R"({"study": "stripes", "protocol": "classification",
    "classes": [{"label": "a", "images": ["wide.png"]}, {"label": "b", "images": ["narrow.png"]}],
    "methods": [{"name": "adaptive"}], "seed": 1})");
  const json sets =
      folder.printed("stimuli measure @study.json @wide.png --photographs @photographs --json")
          .at("sets");
  REQUIRE(sets.size() == 3);
  CHECK(sets[0].at("set") == "stripes");
  CHECK(sets[1].at("set") == "pictures");
  CHECK(sets[2].at("set") == "photographs");
  CHECK(sets[2].at("classes") == 2);
  CHECK(sets[2].at("pictures") == 3);
  CHECK_THAT(folder.done("stimuli measure @wide.png").output, holds_text("wide.png"));
}

TEST_CASE(
    "measure refuses with one line a file that is not a picture, too small, missing or empty") {
  const ProgramFolder folder;
  write_png(folder.path() / "tiny.png", GreyImage(20, 20, 7));
  replace_file(folder.path() / "text.png", "no picture");
  make_folder(folder.path() / "empty");
  check_refused(folder.type("stimuli measure @tiny.png"), 1, {"tiny.png", "32 px"});
  check_refused(folder.type("stimuli measure @text.png"), 1, {"text.png"});
  check_refused(folder.type("stimuli measure @empty"), 1, {"empty"});
  check_refused(folder.type("stimuli measure @none.png"), 2, {"none.png"});
}
