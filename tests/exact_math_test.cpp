#include "obscura/raster/exact_math.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <catch2/catch.hpp>

#include "obscura/tests/fnv1a.h"

using namespace obscura::raster;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kInputs = 50000;

struct Random {  // SplitMix64
  uint64_t state;
  uint64_t next() {
    uint64_t z = state += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double in(double lo, double hi) { return lo + (hi - lo) * (double(next() >> 11) * 0x1p-53); }
  // Random bits with an exponent in [lo, hi]: every magnitude as likely as the next.
  double magnitude(int lo, int hi) {
    const uint64_t e = uint64_t(lo + 1023) + next() % uint64_t(hi - lo + 1);
    const uint64_t bits = (e << 52) | (next() >> 12);
    double x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
  }
};

double ulps(double value, long double exact) {
  int e;
  std::frexp(double(exact), &e);
  const long double ulp = std::ldexp(1.0L, std::max(e - 53, -1074));
  return double(std::fabs((static_cast<long double>(value) - exact) / ulp));
}

double signedMagnitude(Random& random, int lo, int hi) {
  const double sign = random.next() & 1 ? 1 : -1;
  return sign * random.magnitude(lo, hi);
}

}  // namespace

TEST_CASE("exact math: sin, cos and tan are within their stated error for |x| <= 2^20") {
  Random random{1};
  double sinError = 0, cosError = 0, tanError = 0;
  const auto measure = [&](double x) {
    sinError = std::max(sinError, ulps(exactSin(x), std::sin(static_cast<long double>(x))));
    cosError = std::max(cosError, ulps(exactCos(x), std::cos(static_cast<long double>(x))));
    tanError = std::max(tanError, ulps(exactTan(x), std::tan(static_cast<long double>(x))));
  };
  for (int i = 0; i < kInputs; ++i) {
    measure(random.in(-10, 10));
    measure(signedMagnitude(random, -40, 19));
    // The doubles nearest to multiples of pi/2, where the reduction loses most.
    measure(double(int64_t(random.next() % 1300000) - 650000) * 1.5707963267948966);
  }
  measure(0x1p20);
  measure(-0x1p20);
  CAPTURE(sinError, cosError, tanError);
  CHECK(sinError <= 1);
  CHECK(cosError <= 1);
  CHECK(tanError <= 2.5);
}

TEST_CASE("exact math: atan2 is within its stated error in all quadrants and for all magnitudes") {
  Random random{7};
  double error = 0;
  const auto measure = [&](double y, double x) {
    error = std::max(error, ulps(exactAtan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
  };
  for (int i = 0; i < kInputs; ++i) {
    measure(random.in(-1, 1), random.in(-1, 1));
    measure(signedMagnitude(random, -300, 300), signedMagnitude(random, -300, 300));
    // Beside the tabled ratios, where the numerator cancels, and beside those half way between.
    const double x = random.in(1, 2), ratio = double(random.next() % 17) / 16;
    measure(x * ratio * (1 + random.in(-1e-9, 1e-9)), x);
    measure(x, -x * ratio);
  }
  for (double x : {0x1p1023, -0x1p1023, 0x1p-1022}) measure(0x1.8p1023, x), measure(0x1.8p-1021, x);
  CAPTURE(error);
  CHECK(error <= 1);
}

TEST_CASE("exact math: exp is within its stated error wherever the result is a normal number") {
  Random random{2};
  double error = 0;
  const auto measure = [&](double x) {
    error = std::max(error, ulps(exactExp(x), std::exp(static_cast<long double>(x))));
  };
  for (int i = 0; i < kInputs; ++i) {
    measure(random.in(-708.39, 709.78));
    measure(random.in(-2, 2));
    measure(signedMagnitude(random, -60, 8));
  }
  CAPTURE(error);
  CHECK(error <= 1);
}

TEST_CASE("exact math: log is within its stated error for every positive normal number") {
  Random random{3};
  double error = 0;
  const auto measure = [&](double x) {
    error = std::max(error, ulps(exactLog(x), std::log(static_cast<long double>(x))));
  };
  for (int i = 0; i < kInputs; ++i) {
    measure(random.magnitude(-1022, 1023));
    measure(random.in(0.5, 2));
    measure(1 + signedMagnitude(random, -52, -4));
  }
  measure(std::numeric_limits<double>::min());
  measure(std::numeric_limits<double>::max());
  CAPTURE(error);
  CHECK(error <= 1);
}

TEST_CASE("exact math: pow is within its stated error on the sRGB curve and for moderate exponents") {
  Random random{4};
  double error = 0;
  const auto measure = [&](double x, double y) {
    error = std::max(error, ulps(exactPow(x, y), std::pow(static_cast<long double>(x), static_cast<long double>(y))));
  };
  for (int i = 0; i < kInputs; ++i) {
    measure(random.in(0, 1), 2.4);
    measure(random.in(0, 1), 1 / 2.4);
    measure(random.magnitude(-149, 10), 1 / 2.4);
    const double base = random.magnitude(-20, 20);
    measure(base, random.in(-8, 8));
  }
  CAPTURE(error);
  CHECK(error <= 1);
}

TEST_CASE("exact math: pow with a large exponent keeps the relative error stated for it") {
  Random random{5};
  double worst = 0;  // of the relative error over its bound
  for (int i = 0; i < kInputs; ++i) {
    const double y = signedMagnitude(random, 3, 30);
    const double x = 1 + random.in(-600, 600) / std::max(std::fabs(y), 1200.0);
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (!(exact > 1e-300L && exact < 1e300L)) continue;
    const long double error = std::fabs(static_cast<long double>(exactPow(x, y)) / exact - 1);
    worst = std::max(worst, double(error) / (0x1p-52 + std::fabs(y) * 0x1p-58));
  }
  CHECK(worst <= 1);
}

TEST_CASE("exact math: what lies out of range has the documented result") {
  for (double x : {kNaN, kInf, -kInf, 0x1.0000000000001p20, -0x1p30, 1e300}) {
    CHECK(std::isnan(exactSin(x)));
    CHECK(std::isnan(exactCos(x)));
    CHECK(std::isnan(exactTan(x)));
  }
  for (double x : {kNaN, kInf, -kInf}) {
    CHECK(std::isnan(exactAtan2(x, 1)));
    CHECK(std::isnan(exactAtan2(1, x)));
  }
  CHECK(exactAtan2(0, 0) == 0);
  CHECK(exactAtan2(-0.0, -0.0) == 0);
  CHECK(exactAtan2(0, 3) == 0);
  for (double zero : {0.0, -0.0, 5e-324, -5e-324}) {
    CHECK(exactAtan2(zero, -3) == (zero < 0 ? -1 : 1) * 3.141592653589793);
    CHECK(exactAtan2(3, zero) == 3.141592653589793 / 2);
    CHECK(exactAtan2(-3, zero) == -3.141592653589793 / 2);
  }
  CHECK(exactAtan2(1e-300, 1e300) == 0);

  CHECK(exactSin(0.0) == 0);
  CHECK(std::signbit(exactSin(-0.0)));
  CHECK(exactCos(-0.0) == 1);
  CHECK(exactSin(5e-324) == 5e-324);

  CHECK(std::isnan(exactExp(kNaN)));
  CHECK(exactExp(0) == 1);
  CHECK(exactExp(709.79) == kInf);
  CHECK(std::isfinite(exactExp(709.78)));
  CHECK(exactExp(-708.4) == 0);
  CHECK(exactExp(-708.39) >= std::numeric_limits<double>::min());
  CHECK(exactExp(kInf) == kInf);
  CHECK(exactExp(-kInf) == 0);

  CHECK(std::isnan(exactLog(kNaN)));
  CHECK(std::isnan(exactLog(-1)));
  CHECK(std::isnan(exactLog(-kInf)));
  CHECK(exactLog(0.0) == -kInf);
  CHECK(exactLog(-0.0) == -kInf);
  CHECK(exactLog(5e-324) == -kInf);
  CHECK(exactLog(kInf) == kInf);
  CHECK(exactLog(1) == 0);

  CHECK(exactPow(kNaN, 0) == 1);
  CHECK(exactPow(1, kNaN) == 1);
  CHECK(std::isnan(exactPow(kNaN, 2)));
  CHECK(std::isnan(exactPow(2, kNaN)));
  CHECK(std::isnan(exactPow(-2, 2)));
  CHECK(std::isnan(exactPow(-kInf, 2)));
  CHECK(exactPow(0, 2.4) == 0);
  CHECK(exactPow(0, -1) == kInf);
  CHECK(exactPow(kInf, 0.5) == kInf);
  CHECK(exactPow(kInf, -0.5) == 0);
  CHECK(exactPow(2, kInf) == kInf);
  CHECK(exactPow(2, -kInf) == 0);
  CHECK(exactPow(0.5, kInf) == 0);
  CHECK(exactPow(2, 1e300) == kInf);
  CHECK(exactPow(0.5, 1e300) == 0);
  CHECK(exactPow(2, 2000) == kInf);
  CHECK(exactPow(2, -2000) == 0);
  CHECK(exactPow(2, 10) == 1024);
}

TEST_CASE("exact math: the bits of ten thousand results are the same on every machine") {
  Random random{6};
  uint64_t h = obscura::tests::kFnvStart;
  const auto add = [&](double v) { h = obscura::tests::fnv1a(&v, sizeof v, h); };
  for (int i = 0; i < 10000; ++i) {
    const double angle = signedMagnitude(random, -30, 19), positive = random.magnitude(-300, 300);
    add(exactSin(angle));
    add(exactCos(angle));
    add(exactTan(angle));
    add(exactExp(random.in(-720, 720)));
    add(exactLog(positive));
    const double base = random.in(0, 2);
    add(exactPow(base, random.in(-5, 5)));
    const double y = random.in(-1, 1);
    add(exactAtan2(y, random.in(-1, 1)));
  }
  CHECK(h == 0x74bfb8c3ffe5c974ull);
}
