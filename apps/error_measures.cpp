#include "obscura/apps/error_measures.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace obscura::apps {
namespace {

constexpr int kReach = 5;  // of the window

struct Kernel {
  float weight[2 * kReach + 1];
  Kernel() {
    double sum = 0;
    for (int i = -kReach; i <= kReach; ++i) sum += std::exp(-i * i / (2 * 1.5 * 1.5));
    for (int i = -kReach; i <= kReach; ++i) weight[i + kReach] = float(std::exp(-i * i / (2 * 1.5 * 1.5)) / sum);
  }
};

// Rows of value(x, y), blurred both ways; only what the weights add up is in float.
std::vector<float> blurred(int width, int height, raster::Parallel& parallel, const std::function<void(int, float*)>& rowOf) {
  static const Kernel kernel;
  std::vector<float> across(size_t(width) * size_t(height)), out(across.size());
  parallel.forRanges(size_t(height), 16, [&](size_t y0, size_t y1, int) {
    std::vector<float> row(size_t(width) + 2 * kReach);
    for (size_t y = y0; y < y1; ++y) {
      rowOf(int(y), row.data() + kReach);
      std::fill_n(row.begin(), kReach, row[kReach]);
      std::fill_n(row.end() - kReach, kReach, row[size_t(width) + kReach - 1]);
      float* to = &across[y * size_t(width)];
      for (int k = 0; k <= 2 * kReach; ++k)
        for (int x = 0; x < width; ++x) to[x] = (k ? to[x] : 0) + kernel.weight[k] * row[size_t(x + k)];
    }
  });
  parallel.forRanges(size_t(height), 16, [&](size_t y0, size_t y1, int) {
    for (size_t y = y0; y < y1; ++y) {
      float* to = &out[y * size_t(width)];
      for (int k = -kReach; k <= kReach; ++k) {
        const float* from = &across[size_t(std::clamp(int(y) + k, 0, height - 1)) * size_t(width)];
        for (int x = 0; x < width; ++x) to[x] += kernel.weight[k + kReach] * from[x];
      }
    }
  });
  return out;
}

}  // namespace

ErrorMeter::ErrorMeter(PlaneRefs truth, const raster::Plane<uint8_t>& seen, raster::Parallel& parallel)
    : truth_(std::move(truth)), seen_(seen), parallel_(parallel) {
  const int w = seen.width(), h = seen.height();
  for (const auto* t : truth_) {
    mean_.push_back(blurred(w, h, parallel, [&](int y, float* row) { std::copy_n(t->row(y), w, row); }));
    square_.push_back(blurred(w, h, parallel, [&](int y, float* row) {
      for (int x = 0; x < w; ++x) row[x] = t->at(x, y) * t->at(x, y);
    }));
  }
}

double ErrorMeter::ssim(const PlaneRefs& value) const {
  const int w = seen_.width(), h = seen_.height();
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
  double sum = 0, count = 0;
  for (size_t c = 0; c < truth_.size(); ++c) {
    const raster::Plane<float>&v = *value[c], &t = *truth_[c];
    const auto mean = blurred(w, h, parallel_, [&](int y, float* row) { std::copy_n(v.row(y), w, row); });
    const auto square = blurred(w, h, parallel_, [&](int y, float* row) {
      for (int x = 0; x < w; ++x) row[x] = v.at(x, y) * v.at(x, y);
    });
    const auto product = blurred(w, h, parallel_, [&](int y, float* row) {
      for (int x = 0; x < w; ++x) row[x] = v.at(x, y) * t.at(x, y);
    });
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        if (!seen_.at(x, y)) continue;
        const size_t i = size_t(y) * size_t(w) + size_t(x);
        const double a = mean[i], b = mean_[c][i];
        const double varA = square[i] - a * a, varB = square_[c][i] - b * b, both = product[i] - a * b;
        sum += (2 * a * b + c1) * (2 * both + c2) / ((a * a + b * b + c1) * (varA + varB + c2));
        ++count;
      }
  }
  return count > 0 ? sum / count : 1;
}

ErrorMeasures ErrorMeter::measure(const PlaneRefs& value) const {
  ErrorMeasures e;
  std::vector<float> all;
  double squares = 0;
  for (size_t c = 0; c < truth_.size(); ++c)
    for (int y = 0; y < seen_.height(); ++y)
      for (int x = 0; x < seen_.width(); ++x) {
        if (!seen_.at(x, y)) continue;
        const double d = double(value[c]->at(x, y)) - double(truth_[c]->at(x, y));
        e.bias += d, squares += d * d;
        all.push_back(float(std::fabs(d)));
      }
  if (all.empty()) return e;
  const auto p95 = all.begin() + std::ptrdiff_t(double(all.size() - 1) * 0.95);
  std::nth_element(all.begin(), p95, all.end());
  e.p95 = *p95;
  e.max = *std::max_element(p95, all.end());
  e.rmse = std::sqrt(squares / double(all.size()));
  e.bias /= double(all.size());
  e.ssim = ssim(value);
  return e;
}

engine::Image ErrorMeter::map(const PlaneRefs& value, double scale) const {
  engine::Image image(seen_.width(), seen_.height(), 3, engine::Format::U8);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!seen_.at(x, y)) continue;
      double d = 0;
      for (size_t c = 0; c < truth_.size(); ++c)
        d += (double(value[c]->at(x, y)) - double(truth_[c]->at(x, y))) / (scale * double(truth_.size()));
      const auto rest = uint8_t(255 * (1 - std::min(std::fabs(d), 1.0)) + 0.5);
      uint8_t* p = image.row<uint8_t>(y) + 3 * x;
      p[0] = d >= 0 ? 255 : rest, p[1] = rest, p[2] = d > 0 ? rest : 255;
    }
  return image;
}

}  // namespace obscura::apps
