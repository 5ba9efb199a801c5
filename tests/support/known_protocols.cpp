// Registers the program's protocols before a test program's first test.
#include "protocols/registration/registration.hpp"

namespace touchtrial {
namespace {

[[maybe_unused]] const bool kRegistered = [] {
  registration::register_protocols();
  return true;
}();

}  // namespace
}  // namespace touchtrial
