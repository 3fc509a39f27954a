#include "model/decoder_step.hpp"

#include "model/gemm.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kStage = 0x64726f70u;  // of the run's keyed random numbers; + layer

int integer(Eigen::Index n) { return static_cast<int>(n); }

/// x W^T.
RowMatrixXf times_weight(const RowMatrixXf& x, const ConstMatrixMap& w) {
  RowMatrixXf y(x.rows(), w.rows());
  gemm(integer(x.rows()), integer(w.rows()), integer(x.cols()), row_major(x.data(), x.cols()),
       transposed(row_major(w.data(), w.cols())), y.data(), y.cols(), false, Threads::parallel);
  return y;
}

/// weight gradient = dy^T x; returns dx = dy W.
RowMatrixXf linear_backward(const RowMatrixXf& x, const RowMatrixXf& dy, const ConstMatrixMap& w,
                            MatrixMap dw) {
  gemm(integer(dy.cols()), integer(x.cols()), integer(x.rows()), transposed(row_major(dy.data(), dy.cols())),
       row_major(x.data(), x.cols()), dw.data(), dw.cols(), false, Threads::parallel);
  RowMatrixXf dx(x.rows(), x.cols());
  gemm(integer(dy.rows()), integer(x.cols()), integer(dy.cols()), row_major(dy.data(), dy.cols()),
       row_major(w.data(), w.cols()), dx.data(), dx.cols(), false, Threads::parallel);
  return dx;
}
}  // namespace

RowMatrixXf DecoderStep::forward(const std::vector<float>& parameters, const RowMatrixXf& latent,
                                 const DropoutKey& dropout) {
  const auto& layers = parameter_layout().decoder;
  const Eigen::Index clouds = latent.rows();
  for (std::size_t l = 0; l < 2; ++l) {
    Hidden& h = hidden_[l];
    h.input = l == 0 ? latent : hidden_[0].output;
    h.normalised = times_weight(h.input, view(parameters, layers[l].weight));
    h.moments.mean = h.normalised.colwise().mean().transpose();
    h.normalised.rowwise() -= h.moments.mean.transpose();
    h.moments.variance = h.normalised.colwise().squaredNorm().transpose() / static_cast<float>(clouds);
    const Eigen::RowVectorXf inverse = (h.moments.variance.array() + kNormEpsilon).rsqrt().transpose();
    const Eigen::RowVectorXf gain = vector_view(parameters, layers[l].gain).transpose();
    const Eigen::RowVectorXf shift = vector_view(parameters, layers[l].shift).transpose();
    h.passed.resize(clouds, h.normalised.cols());
    h.output.resize(clouds, h.normalised.cols());
    const float kept = static_cast<float>(1 / (1 - dropout.rate));
    parallel_for(static_cast<std::size_t>(clouds), [&](std::size_t i) {
      const auto row = static_cast<Eigen::Index>(i);
      KeyedRandom random(dropout.seed, dropout.first_item + i, kStage + static_cast<std::uint32_t>(l));
      h.normalised.row(row) = h.normalised.row(row).cwiseProduct(inverse);
      const Eigen::RowVectorXf y = h.normalised.row(row).cwiseProduct(gain) + shift;
      for (Eigen::Index c = 0; c < y.size(); ++c) {
        const bool drop = dropout.rate > 0 && random.uniform() < dropout.rate;
        h.passed(row, c) = drop || !(y[c] > 0) ? 0.0f : kept;
      }
      h.output.row(row) = y.cwiseProduct(h.passed.row(row));
    });
  }
  RowMatrixXf out = times_weight(hidden_[1].output, view(parameters, layers[2].weight));
  out.rowwise() += vector_view(parameters, layers[2].shift).transpose();
  return out;
}

RowMatrixXf DecoderStep::backward(const std::vector<float>& parameters, const RowMatrixXf& output_gradient,
                                  std::vector<float>& gradient) const {
  const auto& layers = parameter_layout().decoder;
  vector_view(gradient, layers[2].shift) = output_gradient.colwise().sum().transpose();
  RowMatrixXf d = linear_backward(hidden_[1].output, output_gradient, view(parameters, layers[2].weight),
                                  view(gradient, layers[2].weight));
  for (std::size_t l = 2; l-- > 0;) {
    const Hidden& h = hidden_[l];
    d = d.cwiseProduct(h.passed);
    const Eigen::RowVectorXf shift = d.colwise().sum();
    const Eigen::RowVectorXf gain = d.cwiseProduct(h.normalised).colwise().sum();
    vector_view(gradient, layers[l].shift) = shift.transpose();
    vector_view(gradient, layers[l].gain) = gain.transpose();
    const float n = static_cast<float>(d.rows());
    const Eigen::RowVectorXf scale = vector_view(parameters, layers[l].gain).transpose().array() *
                                     (h.moments.variance.array() + kNormEpsilon).rsqrt().transpose();
    for (Eigen::Index row = 0; row < d.rows(); ++row)
      d.row(row) =
          (d.row(row) - shift / n - h.normalised.row(row).cwiseProduct(gain) / n).cwiseProduct(scale);
    d = linear_backward(h.input, d, view(parameters, layers[l].weight), view(gradient, layers[l].weight));
  }
  return d;
}

}  // namespace polar
