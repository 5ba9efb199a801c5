#include "bench/program.hpp"

int main(int argc, char** argv) {
  return touchtrial::bench::run_program(argc, argv);
}
