#include "device/registry.hpp"

#include "core/errors.hpp"
#include "protocols/design/refusal.hpp"
#include "support/catch.hpp"

#include <set>

namespace touchtrial {

TEST_CASE("every driver has a name of its own and says what it is") {
  std::set<std::string> names;
  for (const device::DeviceDriver& driver : device::device_drivers()) {
    INFO(driver.name);
    CHECK(names.insert(driver.name).second);
    CHECK_FALSE(driver.what.empty());
    CHECK(device::device_driver(driver.name).name == driver.name);
  }
  CHECK(names.count("simulated") == 1);
}

TEST_CASE("every driver has a place in the device settings") {
  for (const device::DeviceDriver& driver : device::device_drivers()) {
    INFO(driver.name);
    const std::string text = R"({")" + driver.name + R"(": {"limits": {"max_force_n": 1.5}}})";
    CHECK(device::parse_device_settings(text, "", "test").use_of(driver.name).limits.max_force_n ==
          1.5);
  }
}

TEST_CASE("every driver is listed whether it has a device or not") {
  std::set<std::string> listed;
  for (const device::DeviceListing& listing : device::list_devices({})) {
    INFO(listing.driver);
    CHECK((listing.present || listing.serial.empty()));
    listed.insert(listing.driver);
  }
  for (const device::DeviceDriver& driver : device::device_drivers())
    CHECK(listed.count(driver.name) == 1);
}

TEST_CASE("a driver that does not exist is refused with the nearest name") {
  const auto opened = [](const char* name) {
    return [=] { return device::open_device(name, {}); };
  };
  CHECK(refuses<UsageError>(opened("simulatd"),
                            "simulatd: there is no such device driver; did "
                            "you mean simulated?"));
  CHECK(refuses<UsageError>(opened("theremin"), "device list"));
}

TEST_CASE("the simulated device opens and gives positions that move") {
  const auto device = device::open_device("simulated", {});
  CHECK(device->info().name == "simulated");
  CHECK(device->info().simulated);
  CHECK_FALSE(device->info().workspace.has_value());
  device::DeviceSample first;
  REQUIRE(device->read(first) == device::DeviceStatus::ok);
  for (int i = 0; i < 500; ++i) REQUIRE(device->write({}) == device::DeviceStatus::ok);
  device::DeviceSample later;
  REQUIRE(device->read(later) == device::DeviceStatus::ok);
  CHECK(norm(later.position_mm - first.position_mm) > 1.0);
  CHECK(later.sequence > first.sequence);
}

}  // namespace touchtrial
