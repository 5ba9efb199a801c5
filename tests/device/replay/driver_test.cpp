#include "device/replay/driver.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

namespace touchtrial {
namespace {

TEST_CASE("replay without a recording says where to name one") {
  const std::vector<device::DeviceListing> listings = device::replay_driver().list({});
  REQUIRE(listings.size() == 1);
  CHECK_FALSE(listings[0].present);
  REQUIRE(listings[0].missing.size() == 1);
  CHECK_THAT(listings[0].missing[0], holds_text("replay.trace"));
  CHECK_THROWS_AS(device::open_device("replay", {}), DeviceError);
}

TEST_CASE("replay is opened through the registry with the recording of the settings") {
  const TempFolder folder;
  const auto file = folder.path() / "motion.csv";
  replace_file(file, "time_s,x_mm,y_mm,z_mm\n0,1,2,3\n0.001,1,2,3\n");
  device::DeviceSettings settings;
  settings.replay.trace = file;
  CHECK(device::replay_driver().list(settings).at(0).present);
  const std::unique_ptr<device::HapticDevice> device = device::open_device("replay", settings);
  std::filesystem::remove(file);
  device::DeviceSample sample;
  CHECK(device->read(sample) == device::DeviceStatus::ok);
  CHECK(sample.position_mm == Vec3{1, 2, 3});
}

}  // namespace
}  // namespace touchtrial
