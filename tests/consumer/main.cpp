#include <cstdio>

#include "obscura/raster/span.h"

int main() {
  const int numbers[] = {1, 2, 3};
  int sum = 0;
  for (int n : obscura::raster::Span<const int>(numbers)) sum += n;
  std::printf("%d\n", sum);
  return sum == 6 ? 0 : 1;
}
