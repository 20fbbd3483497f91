! Isotropic elasticity.
!
! PROPS: 1 Young's modulus [Pa], 2 Poisson's ratio. No state variables.
module umat_counts
  use iso_c_binding, only: c_int
  implicit none
  integer(c_int), bind(c, name="umat_nprops") :: constants = 2
  integer(c_int), bind(c, name="umat_nstatv") :: states = 0
end module umat_counts

subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, &
                celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
  use umat_counts
  implicit none
  character(len=80) :: cmname
  integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
  double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), ddsddt(ntens), drplde(ntens)
  double precision :: stran(ntens), dstran(ntens), time(2), predef(1), dpred(1), props(nprops), coords(3)
  double precision :: drot(3, 3), dfgrd0(3, 3), dfgrd1(3, 3)
  double precision :: sse, spd, scd, rpl, drpldt, dtime, temp, dtemp, pnewdt, celent
  double precision :: mu, lambda
  integer :: i

  mu = 0.5d0 * props(1) / (1.0d0 + props(2))
  lambda = 2.0d0 * mu * props(2) / (1.0d0 - 2.0d0 * props(2))
  ddsdde = 0.0d0
  ddsdde(1:ndi, 1:ndi) = lambda
  do i = 1, ntens
    ddsdde(i, i) = ddsdde(i, i) + merge(2.0d0 * mu, mu, i <= ndi)
  end do
  stress = stress + matmul(ddsdde, dstran)
end subroutine umat
