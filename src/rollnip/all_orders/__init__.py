"""Contact with finite strain of all orders: the geometry "finite".

In "second" the second order of finite strain is added to the influence functions, and every mesh
evaluates it anew. In "finite" all orders are included by finite elements:

    u = u_linear(p, q) + d,    d = c(p, q).

The contact is solved with a correction d that is kept fixed ("held"), then the correction c is
evaluated by finite elements under the tractions of the solution, and so on until both agree.
Anderson acceleration combines the last corrections. In free rolling the correction is a few
hundredths of the first-order terms, and with elastic layers an iteration leaves a seventh of its
error at most.

Where surfaces slip or layers are viscoelastic, d is at first the second order, which costs less
than an iteration with finite elements. Where friction grips a stiff skin there is no second order;
the stretch of both surfaces is held as well.

`iteration` has the loop, `contact_stages` the contact from a coarse mesh to the tolerance,
`corrections` the correction of both rollers, `acceleration` Anderson's method and the decision to
stop, `nearby` the start from a similar nip. With a sheet see `rollnip.sheet.finite_strain`.
"""

from rollnip.all_orders.iteration import refine_all_orders, with_second_order

__all__ = ["refine_all_orders", "with_second_order"]
