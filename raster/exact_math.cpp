#include "obscura/raster/exact_math.h"

#include <cfloat>
#include <cstdint>
#include <cstring>
#include <limits>

#if defined(__FAST_MATH__)
#error "exact_math needs IEEE arithmetic: compile without -ffast-math"
#endif

namespace obscura::raster {
namespace {

static_assert(FLT_EVAL_METHOD == 0, "double arithmetic must round to double after every operation");
static_assert(std::numeric_limits<double>::is_iec559);

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// An unevaluated sum, |lo| <= ulp(hi) / 2 unless said otherwise.
struct Double2 {
  double hi, lo;
};

// hi + lo = a + b exactly (Knuth).
Double2 twoSum(double a, double b) {
  const double s = a + b, bRounded = s - a;
  return {s, (a - (s - bRounded)) + (b - bRounded)};
}

// hi + lo = a b exactly, |a|, |b| < 2^990 (Dekker: both factors split into halves of 26 bits).
Double2 twoProduct(double a, double b) {
  const double p = a * b, aScaled = 134217729.0 * a, bScaled = 134217729.0 * b;  // 2^27 + 1
  const double aHi = aScaled - (aScaled - a), aLo = a - aHi;
  const double bHi = bScaled - (bScaled - b), bLo = b - bHi;
  return {p, ((aHi * bHi - p) + aHi * bLo + aLo * bHi) + aLo * bLo};
}

uint64_t bitsOf(double x) {
  uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

double fromBits(uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

double powerOfTwo(int k) { return fromBits(uint64_t(k + 1023) << 52); }  // -1022 <= k <= 1023

int nearestInteger(double x) { return int(x + (x < 0 ? -0.5 : 0.5)); }  // |x| < 2^31

// x = quarterTurns pi/2 + rest, |rest| < pi/4 (1 + 2^-30), |x| <= 2^20. pi/2 is the sum of four parts of which the
// first three have 33 bits; quarterTurns has 20, so their products are exact and so is the first difference.
Double2 reduceAngle(double x, int& quarterTurns) {
  quarterTurns = nearestInteger(x * 0x1.45f306dc9c883p-1);
  const double k = quarterTurns;
  const Double2 a = twoSum(x - k * 0x1.921fb544p+0, -(k * 0x1.0b4611a6p-34));
  const Double2 b = twoSum(a.hi, -(k * 0x1.3198a2e0p-69));
  return twoSum(b.hi, a.lo + b.lo - k * 0x1.b839a252049c1p-104);
}

// Taylor series; the first term left out is below 2^-62 of the result for |x| <= pi/4.
double sinKernel(Double2 x) {
  const double z = x.hi * x.hi;
  double p = 1.0 / 355687428096000.0;  // 1/17!
  p = p * z - 1.0 / 1307674368000.0;
  p = p * z + 1.0 / 6227020800.0;
  p = p * z - 1.0 / 39916800.0;
  p = p * z + 1.0 / 362880.0;
  p = p * z - 1.0 / 5040.0;
  p = p * z + 1.0 / 120.0;
  p = p * z - 1.0 / 6.0;
  return x.hi + (x.hi * z * p + x.lo * (1.0 - 0.5 * z));  // sin(hi + lo) = sin hi + lo cos hi
}

double cosKernel(Double2 x) {
  const double z = x.hi * x.hi;
  double p = -1.0 / 6402373705728000.0;  // 1/18!
  p = p * z + 1.0 / 20922789888000.0;
  p = p * z - 1.0 / 87178291200.0;
  p = p * z + 1.0 / 479001600.0;
  p = p * z - 1.0 / 3628800.0;
  p = p * z + 1.0 / 40320.0;
  p = p * z - 1.0 / 720.0;
  p = p * z + 1.0 / 24.0;
  const double half = 0.5 * z, head = 1.0 - half;  // what this difference rounds away goes into the tail
  return head + (((1.0 - head) - half) + (z * z * p - x.hi * x.lo));
}

bool tooLargeForAngle(double x) { return !(x >= -0x1p20 && x <= 0x1p20); }  // NaN too
bool tinyAngle(double x) { return x > -0x1p-27 && x < 0x1p-27; }            // x^2 / 2 < 2^-54

// e^(hi + lo), any lo << hi.
double expOf(Double2 x) {
  if (x.hi > 0x1.62e42fefa39efp+9) return kInfinity;
  if (x.hi < -0x1.6232bdd7abcd2p+9) return 0;
  const int k = nearestInteger(x.hi * 0x1.71547652b82fep+0);
  // ln 2 in two parts; k has 11 bits and the first part 42, so k times it is exact and so is the difference.
  const Double2 r = twoSum(x.hi - k * 0x1.62e42fefa38p-1, x.lo - k * 0x1.ef35793c76730p-45);
  double p = 1.0 / 87178291200.0;  // 1/14!: |r| < 0.35, what follows is below 2^-60
  p = p * r.hi + 1.0 / 6227020800.0;
  p = p * r.hi + 1.0 / 479001600.0;
  p = p * r.hi + 1.0 / 39916800.0;
  p = p * r.hi + 1.0 / 3628800.0;
  p = p * r.hi + 1.0 / 362880.0;
  p = p * r.hi + 1.0 / 40320.0;
  p = p * r.hi + 1.0 / 5040.0;
  p = p * r.hi + 1.0 / 720.0;
  p = p * r.hi + 1.0 / 120.0;
  p = p * r.hi + 1.0 / 24.0;
  p = p * r.hi + 1.0 / 6.0;
  p = p * r.hi + 0.5;
  const Double2 head = twoSum(1.0, r.hi);
  const double y = head.hi + (head.lo + (r.hi * r.hi * p + r.lo * (1.0 + r.hi)));
  return k >= 0 ? y * powerOfTwo(k - 1) * 2.0 : y * powerOfTwo(k);  // 2^1024 itself is no double
}

// log of a positive normal number, absolute error below 2^-60 (|log x| + 1) and relative error below 2^-58.
Double2 logOf(double x) {
  const uint64_t bits = bitsOf(x);
  int e = int(bits >> 52) - 1023;
  double m = fromBits((bits & 0xFFFFFFFFFFFFFull) | 0x3FF0000000000000ull);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    e += 1;
  }
  // log m = 2 atanh s = 2 s + s^3 (2/3 + 2/5 s^2 + ...), s = (m - 1) / (m + 1), |s| < 0.1716; s to twice double.
  const double f = m - 1.0;
  const Double2 u = twoSum(1.0, m);
  const double s = f / u.hi;
  const Double2 su = twoProduct(s, u.hi);
  const double sLo = (((f - su.hi) - su.lo) - s * u.lo) / u.hi;
  const double z = s * s;
  double p = 2.0 / 23.0;
  for (int d = 21; d >= 3; d -= 2) p = p * z + 2.0 / d;
  const Double2 head = twoSum(e * 0x1.62e42fefa38p-1, 2.0 * s);  // e times 42 bits is exact
  return twoSum(head.hi, head.lo + (s * z * p + (2.0 * sLo + e * 0x1.ef35793c76730p-45)));
}

// atan(k / 8).
constexpr Double2 kArctangents[9] = {
    {0, 0},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59}, {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56}, {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58}, {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56}, {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
constexpr Double2 kPi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

Double2 difference(Double2 a, Double2 b) {
  const Double2 s = twoSum(a.hi, -b.hi);
  return twoSum(s.hi, s.lo + (a.lo - b.lo));
}

// atan(y / x) for 0 <= y <= x, x in [2^-520, 2^520]. With c = k / 8 next to y / x and r = (y - c x) / (x + c y), |r| < 1/15,
// it is atan c + atan r; the first term left out of the series is below 2^-66 r. r is made to twice double, as y - c x cancels.
Double2 atanOfRatio(double y, double x) {
  const int k = nearestInteger(8.0 * (y / x));
  const double c = k * 0.125;
  const Double2 cx = twoProduct(c, x), cy = twoProduct(c, y);
  const Double2 above = difference({y, 0}, cx), below = difference({x, 0}, {-cy.hi, -cy.lo});
  const double r = above.hi / below.hi;
  const Double2 back = twoProduct(r, below.hi);
  const double rLo = (((above.hi - back.hi) - back.lo) + (above.lo - r * below.lo)) / below.hi;
  const double z = r * r;
  double p = 1.0 / 17.0;
  p = p * z - 1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z - 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z - 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z - 1.0 / 3.0;
  const Double2 head = twoSum(kArctangents[k].hi, r);
  return twoSum(head.hi, head.lo + (kArctangents[k].lo + (r * z * p + rLo)));
}

bool isZeroOrSubnormal(double x) { return (bitsOf(x) << 1 >> 53) == 0; }

}  // namespace

double exactSin(double x) {
  if (tooLargeForAngle(x)) return kNaN;
  if (tinyAngle(x)) return x;
  int quarterTurns;
  const Double2 r = reduceAngle(x, quarterTurns);
  const double y = quarterTurns & 1 ? cosKernel(r) : sinKernel(r);
  return quarterTurns & 2 ? -y : y;
}

double exactCos(double x) {
  if (tooLargeForAngle(x)) return kNaN;
  if (tinyAngle(x)) return 1;
  int quarterTurns;
  const Double2 r = reduceAngle(x, quarterTurns);
  const double y = quarterTurns & 1 ? sinKernel(r) : cosKernel(r);
  return (quarterTurns + 1) & 2 ? -y : y;
}

double exactTan(double x) {
  if (tooLargeForAngle(x)) return kNaN;
  if (tinyAngle(x)) return x;
  int quarterTurns;
  const Double2 r = reduceAngle(x, quarterTurns);
  return quarterTurns & 1 ? -cosKernel(r) / sinKernel(r) : sinKernel(r) / cosKernel(r);
}

double exactAtan2(double y, double x) {
  double ax = x < 0 ? -x : x, ay = y < 0 ? -y : y;
  if (!(ax < kInfinity && ay < kInfinity)) return kNaN;
  if (isZeroOrSubnormal(ax)) ax = 0;
  if (isZeroOrSubnormal(ay)) ay = 0;
  if (ax == 0 && ay == 0) return 0;
  const double larger = ax > ay ? ax : ay, scale = larger > 0x1p500 ? 0x1p-600 : larger < 0x1p-500 ? 0x1p600 : 1.0;
  ax *= scale, ay *= scale;
  Double2 angle = ay > ax ? difference({0.5 * kPi.hi, 0.5 * kPi.lo}, atanOfRatio(ax, ay)) : atanOfRatio(ay, ax);
  if (x < 0) angle = difference(kPi, angle);
  if (isZeroOrSubnormal(angle.hi)) return 0;
  return y < 0 ? -angle.hi : angle.hi;
}

double exactExp(double x) {
  if (x != x) return kNaN;
  return expOf({x, 0});
}

double exactLog(double x) {
  if (x != x) return kNaN;
  if (isZeroOrSubnormal(x)) return -kInfinity;
  if (x < 0) return kNaN;
  if (x == kInfinity) return kInfinity;
  return logOf(x).hi;
}

double exactPow(double x, double y) {
  if (x == 1 || isZeroOrSubnormal(y)) return 1;
  if (x != x || y != y) return kNaN;
  if (isZeroOrSubnormal(x)) return y > 0 ? 0 : kInfinity;
  if (x < 0) return kNaN;
  if (x == kInfinity) return y > 0 ? kInfinity : 0;
  const Double2 l = logOf(x);
  // |log x| >= 2^-53 here: a larger y is out of range in any case, and the product below stays finite.
  if (y > 0x1p64 || y < -0x1p64) return (y > 0) == (l.hi > 0) ? kInfinity : 0;
  const Double2 product = twoProduct(y, l.hi);
  return expOf({product.hi, product.lo + y * l.lo});
}

}  // namespace obscura::raster
