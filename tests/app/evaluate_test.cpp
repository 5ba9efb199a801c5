#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

/// A folder with a blotchy picture, blotchy.png.
struct BlotchyFolder : ProgramFolder {
  explicit BlotchyFolder(int side) {
    RandomStream random(3, "evaluate test");
    GreyImage image(side, side);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto noise = static_cast<int>(random.below(40));
        image.at(y, x) = static_cast<std::uint8_t>(40 + 60 * ((x / 7 + y / 5) % 3) + noise);
      }
    }
    write_png(path() / "blotchy.png", image);
  }
};

}  // namespace

TEST_CASE("evaluate prints both pictures' statistics, and the sweep only on request") {
  const BlotchyFolder folder(20);
  CHECK_THAT(folder.done("evaluate @blotchy.png").output,
             holds_text("energy, adaptive") && !holds_text("MS-SSIM"));
  const json images = folder.printed("evaluate @blotchy.png @blotchy.png --json").at("images");
  REQUIRE(images.size() == 2);
  CHECK(images[0]["image"] == folder.in("blotchy.png"));
  CHECK_FALSE(images[0].contains("orders"));
}

TEST_CASE("evaluate sweeps the fixed orders") {
  const BlotchyFolder folder(161);
  const json swept = folder.printed("evaluate @blotchy.png --sweep --json");
  const json& orders = swept["images"][0]["orders"];
  REQUIRE(orders.size() == 19);
  CHECK(orders[0]["order"] == 0.05);
  CHECK(orders[18]["order"] == 0.95);
}

TEST_CASE("evaluate refuses bad arguments and an image that is too small for MS-SSIM") {
  const BlotchyFolder folder(160);
  check_refused(folder.type("evaluate @blotchy.png --sweep"), 1, {"blotchy.png: has 160 x 160"});
  check_refused(folder.type("evaluate"), 2, {"IMAGE"});
  check_refused(folder.type("evaluate @blotchy.png --swep"), 2, {"--swep --sweep"});
}
