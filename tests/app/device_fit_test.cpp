#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <string>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::engine;
using nlohmann::json;

namespace {

/// A study of two pictures of different sizes, 0.2 mm per pixel, beside empty device settings.
class FitFolder {
 public:
  FitFolder(int side_px, int other_side_px) {
    write_png(folder_.path() / "a.png", GreyImage(side_px, other_side_px, 90));
    write_png(folder_.path() / "b.png", GreyImage(other_side_px, side_px, 90));
    replace_file(folder_.path() / "devices.json", "{}");
    replace_file(folder_.path() / "study.json", R"({"study": "flat", "protocol": "classification",
      "classes": [{"label": "a", "images": ["a.png"]}, {"label": "b", "images": ["b.png"]}],
      "methods": [{"name": "adaptive"}]})");
  }

  [[nodiscard]] ProgramResult fit(std::vector<std::string> more) const {
    std::vector<std::string> words = {"device", "fit", (folder_.path() / "study.json").string(),
                                      "--settings", (folder_.path() / "devices.json").string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_touchtrial(folder_.path(), words);
  }

 private:
  TempFolder folder_;
};

}  // namespace

TEST_CASE("device fit places the part that all pictures cover, without a device") {
  const ProgramResult result = FitFolder(200, 230).fit({"--device", "falcon", "--json"});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  const json fit = json::parse(result.output);
  CHECK(fit.at("fits") == true);
  CHECK(fit.at("plane").at("width_px") == 200);
  CHECK(fit.at("plane").at("height_px") == 200);
  CHECK(fit.at("plane").at("width_mm") == 40.0);
  CHECK(fit.at("orientation") == "horizontal");
  CHECK(fit.at("origin_mm") == json::array({-20.0, 0.0, -20.0}));
  CHECK(fit.at("workspace").at("from") == "maker");
  CHECK(fit.at("workspace").at("shape") == "ellipsoid");
  CHECK(fit.at("crop").is_null());
}

TEST_CASE("device fit places a plane vertically on request") {
  const ProgramResult result =
      FitFolder(200, 200).fit({"--device", "falcon", "--orientation", "vertical", "--json"});
  REQUIRE(result.exit_code == 0);
  CHECK(json::parse(result.output).at("origin_mm") == json::array({-20.0, 20.0, 0.0}));
}

TEST_CASE("device fit refuses a plane that is too large with a crop in pixels") {
  const FitFolder folder(256, 256);
  const ProgramResult result = folder.fit({"--device", "falcon", "--json"});
  CHECK(result.exit_code == 1);
  CHECK(json::parse(result.output).at("crop").at("width_px") == 230);
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text("51.2 x 51.2 mm") && holds_text("230 x 231 px"));
}

TEST_CASE("device fit accepts any plane for a device without a frame of its own") {
  const ProgramResult result = FitFolder(600, 600).fit({"--device", "simulated"});
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.output, holds_text("120.0 x 120.0 mm") && holds_text("fits"));
}

TEST_CASE("device fit refuses a device or an orientation that does not exist") {
  const FitFolder folder(200, 200);
  const ProgramResult device = folder.fit({"--device", "falcn"});
  CHECK(device.exit_code == 2);
  CHECK_THAT(device.errors, holds_text("falcon"));
  CHECK(folder.fit({"--device", "falcon", "--orientation", "diagonal"}).exit_code == 2);
}
