// The module likeness_opencv.so: the only code that OpenCV is linked to.
#include "olat/calibrate/opencv_module.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace {

// f(), whose exceptions become a message.
template <class F>
int guarded(char* error, size_t error_size, const F& f) {
  try {
    f();
    return 0;
  } catch (const std::exception& cause) {
    std::snprintf(error, error_size, "%s", cause.what());
  } catch (...) {
    std::snprintf(error, error_size, "OpenCV failed without a cause");
  }
  return 1;
}

cv::Matx33d matrix_of(const likeness_lens& lens) {
  return {lens.focal_x, 0, lens.center_x, 0, lens.focal_y, lens.center_y, 0, 0, 1};
}

cv::Mat terms_of(const likeness_lens& lens) {
  return cv::Mat(std::vector<double>(lens.distortion, lens.distortion + lens.terms), true);
}

// A header over pixels that are only read; OpenCV has no constant one.
template <class T>
cv::Mat mat_of(const T* pixels, int width, int height, int type) {
  return cv::Mat(height, width, type, const_cast<T*>(pixels));
}

// The corners in the order of the picture's clock, as the contour of a patch has them; nothing if it is no quadrangle.
std::vector<cv::Point2f> quad_of(const std::vector<cv::Point>& contour, double least, double largest) {
  const double area = cv::contourArea(contour);
  if (area < least || area > largest) return {};
  std::vector<cv::Point> hull, sides;
  cv::convexHull(contour, hull);
  if (area < 0.85 * cv::contourArea(hull)) return {};  // bays: no patch
  // Round corners and noise: the polygon is taken ever more coarsely until four corners are left.
  const double length = cv::arcLength(hull, true);
  for (double share = 0.02; share < 0.12 && sides.size() != 4; share += 0.01)
    cv::approxPolyDP(hull, sides, share * length, true);
  if (sides.size() != 4 || cv::contourArea(sides) < 0.8 * area) return {};
  std::vector<cv::Point2f> out(sides.begin(), sides.end());
  double turn = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const cv::Point2f p = out[i], q = out[(i + 1) % 4];
    turn += double(p.x) * double(q.y) - double(q.x) * double(p.y);
  }
  if (turn < 0) std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int likeness_lens_map_1(const likeness_lens* lens, int width, int height,
                                                               float* x, float* y, char* error, size_t error_size) {
  return guarded(error, error_size, [&] {
    const cv::Matx33d k = matrix_of(*lens);
    const cv::Size size(width, height);
    cv::Mat to_x(size, CV_32FC1, x), to_y(size, CV_32FC1, y);
    if (lens->is_fisheye)
      cv::fisheye::initUndistortRectifyMap(k, terms_of(*lens), cv::Matx33d::eye(), k, size, CV_32FC1, to_x, to_y);
    else cv::initUndistortRectifyMap(k, terms_of(*lens), cv::noArray(), k, size, CV_32FC1, to_x, to_y);
  });
}

__attribute__((visibility("default"))) int likeness_bend_1(const likeness_lens* lens, double* points, int count,
                                                           char* error, size_t error_size) {
  return guarded(error, error_size, [&] {
    const cv::Matx33d k = matrix_of(*lens);
    std::vector<cv::Point2d> flat, out;
    std::vector<cv::Point3d> ahead;
    for (int i = 0; i < count; ++i) {
      flat.emplace_back(points[2 * i], points[2 * i + 1]);
      ahead.emplace_back(points[2 * i], points[2 * i + 1], 1);
    }
    if (lens->is_fisheye) cv::fisheye::distortPoints(flat, out, k, terms_of(*lens));
    else cv::projectPoints(ahead, cv::Vec3d(), cv::Vec3d(), k, terms_of(*lens), out);
    for (int i = 0; i < count; ++i) {
      points[2 * i] = out[static_cast<std::size_t>(i)].x;
      points[2 * i + 1] = out[static_cast<std::size_t>(i)].y;
    }
  });
}

__attribute__((visibility("default"))) int likeness_quads_1(const unsigned char* grey, int width, int height,
                                                            double least, double largest, double* quads, int most,
                                                            int* count, char* error, size_t error_size) {
  return guarded(error, error_size, [&] {
    *count = 0;
    const cv::Mat picture = mat_of(grey, width, height, CV_8UC1);
    // A patch is brighter or darker than its frame: each is looked for against a mean over windows of several sizes.
    cv::Mat smooth, marks;
    cv::GaussianBlur(picture, smooth, cv::Size(5, 5), 0);
    const int side = std::max(width, height);
    for (const int share : {8, 16, 32, 64}) {
      const int window = std::max(3, side / share) | 1;
      for (const bool is_bright : {true, false})
        for (const int offset : {2, 6}) {
          cv::adaptiveThreshold(smooth, marks, 255, cv::ADAPTIVE_THRESH_MEAN_C,
                                is_bright ? cv::THRESH_BINARY : cv::THRESH_BINARY_INV, window,
                                is_bright ? -offset : offset);
          cv::erode(marks, marks, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
          std::vector<std::vector<cv::Point>> contours;
          cv::findContours(marks, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
          for (const auto& contour : contours) {
            const auto quad = quad_of(contour, least, largest);
            if (quad.empty() || *count >= most) continue;
            double* out = quads + likeness::olat_calibrate::kQuadNumbers * (*count)++;
            for (const cv::Point2f& corner : quad) *out++ = double(corner.x), *out++ = double(corner.y);
            const cv::Moments moments = cv::moments(contour);
            *out++ = moments.m10 / moments.m00, *out++ = moments.m01 / moments.m00;
          }
        }
    }
  });
}
}
