/// BLAS as the kernels of this program want it.
#pragma once

namespace meniscus {

/// One thread of BLAS: its sums change with their number. To be called before
/// the first use in each thread; throws SolverError where a limit of address
/// space leaves no room for its buffers.
void prepare_blas();

}  // namespace meniscus
