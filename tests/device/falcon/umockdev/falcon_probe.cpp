// A program for the tests: does with the Falcon what its argument says, and prints each step.
//   list            every Falcon on the bus
//   push FIRMWARE   opens it, waits until it is homed, pushes with 1 N until it is lost, and again
#include "core/errors.hpp"
#include "device/falcon/falcon_device.hpp"
#include "device/falcon/usb_falcon.hpp"

#include <chrono>
#include <iostream>
#include <string>
#include <thread>

namespace {

using namespace touchtrial;
using namespace touchtrial::device;

void list() {
  for (const falcon::UsbFalcon& found : falcon::find_usb_falcons()) {
    std::cout << found.where << ", serial " << found.serial << ", " << found.trouble << std::endl;
  }
}

std::unique_ptr<falcon::FtdiTransport> wait_for_falcon() {
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
    const auto found = falcon::find_usb_falcons();
    if (!found.empty() && found.front().trouble.empty()) return falcon::open_usb_falcon("");
  }
}

void push_until_lost(const std::string& firmware) {
  FalconSettings settings;
  settings.firmware = firmware;
  falcon::FalconDevice device(wait_for_falcon(), settings);
  std::cout << "open " << device.info().serial << std::endl;
  bool told = false;
  DeviceSample sample;
  while (device.read(sample) == DeviceStatus::ok) {
    if (sample.ready && !told) std::cout << "homed" << std::endl;
    told = sample.ready;
    static_cast<void>(device.write({0.0, 0.0, 1.0}));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::cout << (device.fault() == DeviceFault::link_lost ? "lost" : "other fault") << std::endl;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count == 2) {
      list();
    } else {
      push_until_lost(arguments[2]);
      push_until_lost(arguments[2]);
    }
  } catch (const Error& error) {
    std::cout << error.what() << std::endl;
    return 1;
  }
}
