#include "fitting/view_correction/outer_products_kernel.h"

namespace glint::kernel {

AddProducts BaselineAddProducts();
AddProducts Avx2AddProducts();
AddProducts Avx512AddProducts();

AddProducts AddProductsFor(InstructionSet set) {
#ifdef GLINT_X86_KERNELS
  if (set == InstructionSet::kAvx512) return Avx512AddProducts();
  if (set == InstructionSet::kAvx2) return Avx2AddProducts();
#endif
  (void)set;
  return BaselineAddProducts();
}

}  // namespace glint::kernel
