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

namespace {

/// A study of two pictures of different sizes, 0.2 mm per pixel, beside empty device settings.
class FitFolder {
 public:
  /// \param rendering  a member of the study file, with a comma in front; may be empty
  FitFolder(int side_px, int other_side_px, const std::string& rendering = "") {
    write_png(folder_.path() / "a.png", GreyImage(side_px, other_side_px, 90));
    write_png(folder_.path() / "b.png", GreyImage(other_side_px, side_px, 90));
    replace_file(folder_.path() / "devices.json",
                 R"({"openhaptics": {"library": ")" TOUCHTRIAL_FAKE_HD R"("}})");
    replace_file(folder_.path() / "study.json", R"({"study": "flat", "protocol": "classification",
      "classes": [{"label": "a", "images": ["a.png"]}, {"label": "b", "images": ["b.png"]}],
      "methods": [{"name": "adaptive"}])" + rendering +
                                                    "}");
  }

  [[nodiscard]] ProgramResult fit(std::vector<std::string> more) const {
    std::vector<std::string> words = {"device", "fit", (folder_.path() / "study.json").string(),
                                      "--settings", (folder_.path() / "devices.json").string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_touchtrial(folder_.path(), words);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TempFolder folder_;
};

}  // namespace

TEST_CASE("device fit places the part that all pictures cover, without a device") {
  const ProgramResult result = succeeded(FitFolder(200, 230).fit({"--device", "falcon", "--json"}));
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
  const ProgramResult result = succeeded(
      FitFolder(200, 200).fit({"--device", "falcon", "--orientation", "vertical", "--json"}));
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
  const ProgramResult result = succeeded(FitFolder(600, 600).fit({"--device", "simulated"}));
  CHECK_THAT(result.output, holds_text("120.0 x 120.0 mm") && holds_text("fits"));
}

TEST_CASE("device fit does not say that a plane fits a model without a workspace") {
  const ProgramResult result = succeeded(FitFolder(600, 600).fit({"--device", "premium_1_5"}));
  CHECK_THAT(result.output, holds_text("has no workspace") && !holds_text("fits"));
}

TEST_CASE("device fit compares a study's stiffness with what the device says that it renders") {
  const auto fit = [](const std::string& wall, std::vector<std::string> more) {
    more.insert(more.end(), {"--device", "openhaptics"});
    return FitFolder(
               200, 200,
               R"(, "rendering": {"texture_stiffness_n_per_mm": 0.3, "stiffness_n_per_mm": )" +
                   wall + "}")
        .fit(more);
  };
  const ProgramResult below = succeeded(fit("0.3", {"--json"}));
  CHECK(below.errors.empty());
  const json stiffness = json::parse(below.output).at("stiffness");
  CHECK(stiffness.at("wall_n_per_mm") == 0.3);
  CHECK(stiffness.at("limit_n_per_mm").get<double>() == Approx(0.4));
  CHECK(stiffness.at("damping_limit_n_s_per_mm").get<double>() == Approx(0.004));

  const ProgramResult at = succeeded(fit("0.4", {}));
  CHECK_THAT(at.output, holds_text("0.4 N/mm of the wall") && holds_text("at most 0.4 N/mm"));
  CHECK_THAT(at.errors, holds_text("at the device's own limit"));

  const ProgramResult beyond = fit("0.5", {});
  CHECK(beyond.exit_code == 1);
  CHECK_THAT(beyond.errors, holds_text("rendering.stiffness_n_per_mm of 0.5 N/mm is beyond"));
}

TEST_CASE("device fit takes a product's model where no device of it can be opened") {
  const FitFolder folder(200, 200);
  replace_file(folder.path() / "devices.json", R"({"dhd": {"library": "gone.so"}})");
  const ProgramResult product = succeeded(folder.fit({"--device", "omega", "--json"}));
  const json fit = json::parse(product.output);
  CHECK(fit.at("driver") == "dhd");
  CHECK(fit.at("model") == "omega_3");
  CHECK(fit.at("workspace").at("from") == "model");
  CHECK(fit.at("stiffness").at("limit_n_per_mm").get<double>() > 0.0);
  CHECK(folder.fit({"--device", "dhd"}).exit_code == 1);
  CHECK(folder.fit({"--device", "sigma"}).exit_code == 1);
  CHECK(json::parse(folder.fit({"--device", "touch_x", "--json"}).output).at("model") == "touch_x");
}

TEST_CASE("device fit takes the study's device, and of that its model") {
  const FitFolder named(200, 200, R"(, "rendering": {"device": "omega"})");
  const ProgramResult result = succeeded(named.fit({"--json"}));
  CHECK(json::parse(result.output).at("model") == "omega_3");
  CHECK(json::parse(result.output).at("device") == "omega");
  check_refused(FitFolder(200, 200).fit({}), 2, {"/rendering/device"});
}

TEST_CASE("device fit refuses a certificate that no session takes") {
  const FitFolder folder(200, 200);
  const std::string file = (folder.path() / "c.json").string();
  const ProgramResult rehearsal = run_touchtrial(
      folder.path(),
      {"device", "accept", "--emulate", "falcon", "--skip", "push", "--certificate", file});
  REQUIRE(rehearsal.exit_code == 1);
  json certificate = json::parse(text_of(read_file(file)));
  const auto refusal = [&](const std::string& key, const std::string& value) {
    certificate[key] = value;
    replace_file(file, certificate.dump());
    const ProgramResult result = folder.fit({"--device", "falcon", "--certificate", file});
    CHECK(result.exit_code == 1);
    CHECK(line_count(result.errors) == 1);
    return result.errors;
  };
  CHECK_THAT(refusal("driver", "falcon"), holds_text("proves no device"));
  CHECK_THAT(refusal("emulated", ""), holds_text("says that it failed"));
  CHECK_THAT(refusal("driver", "dhd"), holds_text("is for") && holds_text("dhd"));
}

TEST_CASE("device fit refuses a device or an orientation that does not exist") {
  const FitFolder folder(200, 200);
  const ProgramResult device = folder.fit({"--device", "falcn"});
  CHECK(device.exit_code == 2);
  CHECK_THAT(device.errors, holds_text("falcon"));
  CHECK(folder.fit({"--device", "falcon", "--orientation", "diagonal"}).exit_code == 2);
}

TEST_CASE("device fit says how strong the stimuli are once the study is prepared") {
  const FitFolder folder(200, 200);
  const auto levels = [&] {
    const ProgramResult result = succeeded(folder.fit({"--device", "falcon", "--json"}));
    return json::parse(result.output).at("levels");
  };
  CHECK(levels().is_null());
  const ProgramResult prepared = succeeded(run_touchtrial(
      folder.path(), {"prepare", (folder.path() / "study.json").string(), "--json"}));
  const json there = json::parse(prepared.output);
  CHECK(levels().at("blank") == there.at("blank").at("levels"));
  const json fit = json::parse(folder.fit({"--device", "falcon", "--json"}).output);
  CHECK_THAT(fit.at("simulated_on").get<std::string>(), holds_text("modelled device falcon"));
  REQUIRE(levels().at("stimuli").size() == 2);
  // Both are the same grey: prepare lists them in the order of their codes.
  CHECK(levels().at("stimuli")[0].at("levels") == there.at("stimuli")[0].at("levels"));
}
