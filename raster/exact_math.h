// Elementary functions with the same bits on every machine.
// In: doubles.  Out: doubles, from + - * / sqrt, integer and bit operations only: no libm, no fused operations.
#pragma once

namespace obscura::raster {

// Errors are in units in the last place against the exact value, as measured by tests/exact_math_test.cpp. They
// hold with rounding to nearest. A NaN argument gives the quiet NaN, but for exactPow(NaN, 0) = exactPow(1, NaN) = 1.
// Subnormal numbers count as 0 and are never returned (but by sin and tan of themselves), so that a host which
// flushes them to zero sees the same results.

// Radians, |x| <= 2^20; beyond that, and for infinities, NaN. sin, cos: 1 ulp. tan: 2.5 ulp.
double exactSin(double x);
double exactCos(double x);
double exactTan(double x);

// The angle of (x, y) from the x axis in radians, [-pi, pi]: 1 ulp. 0 for (0, 0), positive where y is zero of either sign.
// Coordinates that are not finite: NaN. asin s = exactAtan2(s, sqrt((1 - s) (1 + s))), and acos alike.
double exactAtan2(double y, double x);

// 1 ulp. Infinity above 709.782 (ln of the largest double), 0 below -708.396 (ln of the smallest normal one).
double exactExp(double x);

// Natural logarithm, 1 ulp. -infinity at 0, infinity at infinity, NaN below 0.
double exactLog(double x);

// x to the power y for x >= 0: 1 ulp for |y log x| <= 128 and |y| <= 8, which holds the sRGB curve; elsewhere the
// relative error is at most 2^-52 + |y| 2^-58. Negative x: NaN, whatever y. pow(x, 0) = pow(1, y) = 1;
// pow(0, y) = 0 for y > 0, infinity for y < 0. Overflow and underflow as for exactExp.
double exactPow(double x, double y);

}  // namespace obscura::raster
