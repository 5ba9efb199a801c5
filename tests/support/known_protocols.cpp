// Makes the program's protocols known to a test program before its first test.
#include "protocols/registration/registration.hpp"

namespace touchtrial {
namespace {

[[maybe_unused]] const bool kRegistered = [] {
  registration::register_protocols();
  return true;
}();

}  // namespace
}  // namespace touchtrial
