// Linked into every program under AddressSanitizer. Libraries stay loaded, so that leaks of third
// parties (mostly graphics drivers) have symbols for tests/leaks-of-others.txt.
extern "C" int dlclose(void* /*library*/) noexcept {
  return 0;
}
