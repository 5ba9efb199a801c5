#include "app/device_folder.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

/// A study of two pictures of different sizes, 0.2 mm per pixel.
struct FitFolder : DeviceFolder {
  /// \param rendering  the study file's
  FitFolder(int side_px, int other_side_px, const json& rendering = json::object())
      : DeviceFolder(json{{"openhaptics", {{"library", TOUCHTRIAL_FAKE_HD}}}}) {
    write_png(path() / "a.png", GreyImage(side_px, other_side_px, 90));
    write_png(path() / "b.png", GreyImage(other_side_px, side_px, 90));
    json study = json::parse(R"({"study": "flat", "protocol": "classification",
      "classes": [{"label": "a", "images": ["a.png"]}, {"label": "b", "images": ["b.png"]}],
      "methods": [{"name": "adaptive"}]})");
    study["rendering"] = rendering;
    replace_file(path() / "study.json", study.dump());
  }
  [[nodiscard]] ProgramResult fit(const std::string& options) const {
    return device("fit @study.json " + options);
  }
  [[nodiscard]] json fitted(const std::string& options) const {
    return json::parse(succeeded(fit(options + " --json")).output);
  }
};

}  // namespace

TEST_CASE("device fit places the part that all pictures cover, without a device") {
  const json fit = FitFolder(200, 230).fitted("--device falcon");
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
  CHECK(FitFolder(200, 200).fitted("--device falcon --orientation vertical").at("origin_mm") ==
        json::array({-20.0, 20.0, 0.0}));
}

TEST_CASE("device fit refuses a plane that is too large with a crop in pixels") {
  const ProgramResult result = FitFolder(256, 256).fit("--device falcon --json");
  CHECK(result.exit_code == 1);
  CHECK(json::parse(result.output).at("crop").at("width_px") == 230);
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text("51.2 x 51.2 mm") && holds_text("230 x 231 px"));
}

TEST_CASE(
    "device fit takes any plane where a device has no frame, and not where a model has none") {
  const FitFolder folder(600, 600);
  CHECK_THAT(succeeded(folder.fit("--device simulated")).output,
             holds_text("120.0 mm") && holds_text("fits"));
  CHECK_THAT(succeeded(folder.fit("--device premium_1_5")).output, holds_text("premium_1_5"));
}

TEST_CASE("device fit compares a study's stiffness with the device's reported limit") {
  const auto with_wall = [](double wall_n_per_mm) {
    return FitFolder(200, 200,
                     {{"texture_stiffness_n_per_mm", 0.3}, {"stiffness_n_per_mm", wall_n_per_mm}});
  };
  const ProgramResult below = succeeded(with_wall(0.3).fit("--device openhaptics --json"));
  CHECK(below.errors.empty());
  const json stiffness = json::parse(below.output).at("stiffness");
  CHECK(stiffness.at("wall_n_per_mm") == 0.3);
  CHECK(stiffness.at("limit_n_per_mm").get<double>() == Approx(0.4));
  CHECK(stiffness.at("damping_limit_n_s_per_mm").get<double>() == Approx(0.004));

  const ProgramResult at = succeeded(with_wall(0.4).fit("--device openhaptics"));
  CHECK(names_in_order(at.output, "0.4 N/mm 0.4 N/mm"));
  CHECK(names_in_order(at.errors, "0.4 N/mm"));

  const ProgramResult beyond = with_wall(0.5).fit("--device openhaptics");
  CHECK(beyond.exit_code == 1);
  CHECK(names_in_order(beyond.errors, "rendering.stiffness_n_per_mm 0.5 N/mm"));
}

TEST_CASE("device fit takes a product's model where no device of it can be opened") {
  const FitFolder folder(200, 200);
  replace_file(folder.path() / "devices.json", R"({"dhd": {"library": "gone.so"}})");
  const json fit = folder.fitted("--device omega");
  CHECK(fit.at("driver") == "dhd");
  CHECK(fit.at("model") == "omega_3");
  CHECK(fit.at("workspace").at("from") == "model");
  CHECK(fit.at("stiffness").at("limit_n_per_mm").get<double>() > 0.0);
  CHECK(folder.fit("--device dhd").exit_code == 1);
  CHECK(folder.fit("--device sigma").exit_code == 1);
  CHECK(folder.fitted("--device touch_x").at("model") == "touch_x");
}

TEST_CASE("device fit takes the study's device, and of that its model") {
  const json fit = FitFolder(200, 200, {{"device", "omega"}}).fitted("");
  CHECK(fit.at("model") == "omega_3");
  CHECK(fit.at("device") == "omega");
  check_refused(FitFolder(200, 200).fit(""), 2, {"/rendering/device"});
}

TEST_CASE("device fit refuses a certificate that no session takes") {
  const FitFolder folder(200, 200);
  REQUIRE(
      folder.type("device accept --emulate falcon --skip push --certificate @c.json").exit_code ==
      1);
  json certificate = folder.object_in("c.json");
  const auto refusal = [&](const std::string& key, const std::string& value) {
    certificate[key] = value;
    replace_file(folder.path() / "c.json", certificate.dump());
    const ProgramResult result = folder.fit("--device falcon --certificate @c.json");
    CHECK(result.exit_code == 1);
    CHECK(line_count(result.errors) == 1);
    return result.errors;
  };
  CHECK_FALSE(refusal("driver", "falcon").empty());
  CHECK_FALSE(refusal("emulated", "").empty());
  CHECK_THAT(refusal("driver", "dhd"), holds_text("dhd"));
}

TEST_CASE("device fit refuses a device or an orientation that does not exist") {
  const FitFolder folder(200, 200);
  check_refused(folder.fit("--device falcn"), 2, {"falcon"});
  check_refused(folder.fit("--device falcon --orientation diagonal"), 2,
                {"--orientation diagonal"});
}
