/// \file The fake libHD, loaded.
#pragma once

#include "device/fakes/fake_hd.hpp"
#include "device/fakes/loaded_fake.hpp"

namespace touchtrial::fakes {

struct LoadedHd : LoadedFake<FakeHdExports> {
  LoadedHd() : LoadedFake(TOUCHTRIAL_FAKE_HD, "fake_hd_exports") {}
};

}  // namespace touchtrial::fakes
