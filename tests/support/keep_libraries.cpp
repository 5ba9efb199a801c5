// Linked into every program under AddressSanitizer: libraries stay loaded, so that what those of
// others leak (drivers of the graphics card, above all) has a name in tests/leaks-of-others.txt.
extern "C" int dlclose(void* /*library*/) noexcept {
  return 0;
}
