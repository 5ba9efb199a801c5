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

/// Writes a blotchy picture.
/// \return its path
std::string picture_in(const TempFolder& folder, const std::string& name, int side) {
  RandomStream random(3, "evaluate test");
  GreyImage image(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto noise = static_cast<int>(random.below(40));
      image.at(y, x) = static_cast<std::uint8_t>(40 + 60 * ((x / 7 + y / 5) % 3) + noise);
    }
  }
  const fs::path path = folder.path() / name;
  write_png(path, image);
  return path.string();
}

}  // namespace

TEST_CASE("evaluate prints both pictures' statistics, and the sweep only on request") {
  const TempFolder folder;
  const std::string path = picture_in(folder, "small.png", 20);
  const ProgramResult text = run_touchtrial(folder.path(), {"evaluate", path});
  INFO(text.errors);
  CHECK(text.exit_code == 0);
  CHECK_THAT(text.output, holds_text("energy, adaptive"));
  CHECK(text.output.find("MS-SSIM") == std::string::npos);
  const ProgramResult result = run_touchtrial(folder.path(), {"evaluate", path, path, "--json"});
  const json object = json::parse(result.output);
  REQUIRE(object["images"].size() == 2);
  CHECK(object["images"][0]["image"] == path);
  CHECK_FALSE(object["images"][0].contains("orders"));
}

TEST_CASE("evaluate sweeps the fixed orders") {
  const TempFolder folder;
  const std::string path = picture_in(folder, "large.png", 161);
  const ProgramResult result =
      run_touchtrial(folder.path(), {"evaluate", path, "--sweep", "--json"});
  const json orders = json::parse(result.output)["images"][0]["orders"];
  REQUIRE(orders.size() == 19);
  CHECK(orders[0]["order"] == 0.05);
  CHECK(orders[18]["order"] == 0.95);
}

TEST_CASE("evaluate names an image that is too small for MS-SSIM") {
  const TempFolder folder;
  const std::string path = picture_in(folder, "small.png", 160);
  const ProgramResult result = run_touchtrial(folder.path(), {"evaluate", path, "--sweep"});
  CHECK(result.exit_code == 1);
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text("small.png: has 160 x 160 px; MS-SSIM needs at least 161"));
  CHECK(result.output.empty());
}

TEST_CASE("evaluate refuses bad arguments with exit 2 and one line") {
  const TempFolder folder;
  const std::string path = picture_in(folder, "small.png", 5);
  for (const auto& arguments :
       std::vector<std::vector<std::string>>{{"evaluate"}, {"evaluate", path, "--swep"}}) {
    const ProgramResult result = run_touchtrial(folder.path(), arguments);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
  }
}
