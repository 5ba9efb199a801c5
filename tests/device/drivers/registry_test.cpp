#include "device/drivers/registry.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <filesystem>
#include <set>
#include <string_view>

namespace touchtrial {

using namespace device;

TEST_CASE("every driver has a unique name and a description") {
  std::set<std::string> names;
  for (const DeviceDriver& driver : device_drivers()) {
    INFO(driver.name);
    CHECK(names.insert(driver.name).second);
    CHECK_FALSE(driver.what.empty());
    CHECK(device::device_driver(driver.name).name == driver.name);
  }
  CHECK(names.count("simulated") == 1);
}

TEST_CASE("a product's name is that of one driver, and opens it") {
  std::set<std::string_view> names;
  for (const std::string_view name : device_names()) {
    INFO(name);
    CHECK(names.insert(name).second);
  }
  int products = 0;
  for (const DeviceDriver& driver : device_drivers()) {
    for (const DeviceProduct& product : driver.products) {
      INFO(product.name);
      CHECK(device::device_driver(product.name).name == driver.name);
      CHECK_FALSE(product.title.empty());
      ++products;
    }
  }
  CHECK(products > 10);
}

TEST_CASE(
    "a product with a model is simulated on it, by any name of either, and others are refused") {
  for (const DeviceDriver& driver : device_drivers()) {
    for (const DeviceProduct& product : driver.products) {
      if (product.model.empty()) continue;
      INFO(product.name);
      CHECK(model_of_device(product.name).name == product.model);
      CHECK(model_of_device(product.model).name == product.model);
      REQUIRE(driver_of_model(product.model) != nullptr);
      CHECK(driver_of_model(product.model)->name == driver.name);
    }
  }
  CHECK(driver_of_model("ideal") == nullptr);
  CHECK(driver_of_model("") == nullptr);
  CHECK(model_of_device("omega").name == "omega_3");
  for (const char* name : {"sigma", "theremin", ""}) {
    CHECK(refuses<UsageError>([=] { static_cast<void>(model_of_device(name)); }, "falcon ideal"));
  }
  CHECK(refuses<UsageError>([] { static_cast<void>(model_of_device("omgea")); }, "omgea omega"));
  CHECK_THROWS_AS(model_of_device("gone/mine.json"), FileError);
}

TEST_CASE("docs/devices names every driver with every product that it serves") {
  const std::string page = text_of(
      read_file(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "docs" / "devices" / "README.md"));
  for (const DeviceDriver& driver : device_drivers()) {
    INFO(driver.name);
    const std::size_t row = page.find("\n| `" + driver.name + "` |");
    REQUIRE(row != std::string::npos);
    const std::string line = page.substr(row, page.find('\n', row + 1) - row);
    for (const DeviceProduct& product : driver.products) {
      INFO(product.title);
      CHECK(line.find(product.title + " (`" + product.name + "`)") != std::string::npos);
    }
  }
}

TEST_CASE("every driver has a place in the device settings, by each of its names") {
  for (const DeviceDriver& driver : device_drivers()) {
    for (const std::string_view name : driver.names()) {
      INFO(name);
      const std::string text =
          "{\"" + std::string(name) + R"(": {"limits": {"max_force_n": 1.5}}})";
      CHECK(parse_device_settings(text, "", "test").use_of(driver.name).limits.max_force_n == 1.5);
    }
  }
  CHECK(refuses<StudyError>(
      [] { return parse_device_settings(R"({"omega": {}, "dhd": {}})", "", "test"); }, "/omega"));
}

TEST_CASE("every driver is listed whether it has a device or not") {
  std::set<std::string> listed;
  for (const DeviceListing& listing : list_devices({})) {
    INFO(listing.driver);
    CHECK((listing.present || listing.serial.empty()));
    listed.insert(listing.driver);
  }
  for (const DeviceDriver& driver : device_drivers()) CHECK(listed.count(driver.name) == 1);
}

TEST_CASE("a driver that does not exist is refused with the nearest name") {
  const auto opened = [](const char* name) { return [=] { return open_device(name, {}); }; };
  CHECK(refuses<UsageError>(opened("simulatd"), "simulatd simulated"));
  CHECK(refuses<UsageError>(opened("omgea"), "omgea omega"));
  CHECK(refuses<UsageError>(opened("theremin"), "theremin"));
}

}  // namespace touchtrial
