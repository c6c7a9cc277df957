// Motion filters of Python's own.
#include "bindings.h"

namespace marey::python {
namespace {

/// A row of numbers as a Python list.
template <typename Values>
nb::list list_of(const Values& values) {
  nb::list list;
  for (Eigen::Index i = 0; i < values.size(); ++i) list.append(values.data()[i]);
  return list;
}

/// An object of python/marey/_filters.py, whose every call returns position, velocity and covariance in one row of 2 D + D²
/// numbers.
template <int D>
class ObjectModel final : public filter::CustomModel<D> {
 public:
  /// `make(z, R, unit)`, z and R as flat lists.
  ObjectModel(const Held& make, const Vector<D>& z, const Matrix<D>& R, double unit) {
    const nb::gil_scoped_acquire gil;
    object_ = std::make_shared<Held>(make.get()(list_of(z), list_of(R), unit));
    read(object_->get().attr("estimate")());
  }

  std::unique_ptr<filter::CustomModel<D>> copy() const override {
    const nb::gil_scoped_acquire gil;
    auto twin = std::make_unique<ObjectModel>(*this);
    twin->object_ = std::make_shared<Held>(object_->get().attr("copy")());
    return twin;
  }
  void predict(double dt) override {
    const nb::gil_scoped_acquire gil;
    read(object_->get().attr("predict")(dt));
  }
  void correct(const Vector<D>& z, const Matrix<D>& R) override {
    const nb::gil_scoped_acquire gil;
    read(object_->get().attr("correct")(list_of(z), list_of(R)));
  }
  filter::MotionEstimate<D> estimate() const override { return estimate_; }

 private:
  void read(const nb::object& given) {
    const auto row = nb::cast<nb::ndarray<const double, nb::shape<2 * D + D * D>, nb::c_contig>>(given);
    estimate_.position = Eigen::Map<const Vector<D>>(row.data());
    estimate_.velocity = Eigen::Map<const Vector<D>>(row.data() + D);
    estimate_.covariance = Eigen::Map<const Matrix<D>>(row.data() + 2 * D);
  }

  std::shared_ptr<Held> object_;
  filter::MotionEstimate<D> estimate_;
};

template <int D>
filter::MakeCustomModel<D> maker_of(const std::shared_ptr<Held>& make) {
  return
      [make](const Vector<D>& z, const Matrix<D>& R, double unit) { return std::make_unique<ObjectModel<D>>(*make, z, R, unit); };
}

}  // namespace

filter::CustomFilterOptions filter_of(const std::shared_ptr<Held>& make) {
  const nb::gil_scoped_acquire gil;
  return {.name = nb::cast<std::string>(make->get().attr("name")), .plane = maker_of<2>(make), .space = maker_of<3>(make)};
}

}  // namespace marey::python
