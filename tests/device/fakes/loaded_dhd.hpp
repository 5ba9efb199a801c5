/// \file The fake libdhd, loaded.
#pragma once

#include "device/fakes/fake_dhd.hpp"
#include "device/fakes/loaded_fake.hpp"

namespace touchtrial::fakes {

struct LoadedDhd : LoadedFake<FakeDhdExports> {
  LoadedDhd() : LoadedFake(TOUCHTRIAL_FAKE_DHD, "fake_dhd_exports") {}
};

}  // namespace touchtrial::fakes
