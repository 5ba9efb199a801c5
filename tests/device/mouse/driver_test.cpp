#include "device/mouse/driver.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"

#include <cstdlib>
#include <optional>

#include <stdlib.h>

namespace touchtrial {
namespace {

/// Sets or removes a variable of the environment for as long as it lives.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST_CASE("the mouse is there where a display is, and says what is missing elsewhere") {
  const Variable wayland("WAYLAND_DISPLAY", nullptr);
  {
    const Variable display("DISPLAY", ":7");
    const device::DeviceListing listing = device::mouse_driver().list({}).at(0);
    CHECK(listing.present);
    CHECK(listing.where == ":7");
    CHECK(listing.missing.empty());
  }
  const Variable no_display("DISPLAY", nullptr);
  const device::DeviceListing listing = device::mouse_driver().list({}).at(0);
  CHECK_FALSE(listing.present);
  REQUIRE(listing.missing.size() == 1);
  CHECK_THAT(listing.missing[0], holds_text("graphical session"));
}

TEST_CASE("the registry knows the mouse, and says that only a window can open it") {
  CHECK_THROWS_AS(device::open_device("mouse", {}), DeviceError);
  bool listed = false;
  for (const device::DeviceListing& listing : device::list_devices({}))
    listed |= listing.driver == "mouse";
  CHECK(listed);
}

}  // namespace
}  // namespace touchtrial
