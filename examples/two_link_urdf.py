"""An arm of two links from its URDF: which joint is pushed, and when does the observer say so?"""

import numpy as np
import pinocchio as pin
from simulated import RATE_HZ, draw, moved

import mobnet

LINK = """<link name="{0}"><inertial><origin xyz="0 0 -0.2"/><mass value="2"/>
<inertia ixx="0.03" iyy="0.03" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><origin xyz="0 0 {3}"/>
<axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="5"/></joint>"""
URDF = f"""<robot name="two-link arm"><link name="wall"/>{LINK.format("upper")}{LINK.format("lower")}
{JOINT.format("shoulder", "wall", "upper", 0)}{JOINT.format("elbow", "upper", "lower", -0.4)}</robot>"""
THRESHOLD_NM = 1.0

model = pin.buildModelFromXML(URDF)
push = np.array([0.0, 3.0])
q, v, tau = moved(model, push)

observer = mobnet.MomentumObserver(model, RATE_HZ)
residual = observer.run(q, v, tau)

print(observer)
for column, joint in enumerate(observer.joints):
    flags = np.flatnonzero(np.abs(residual[:, column]) > THRESHOLD_NM)
    print(f"{joint}: {f'pushed from {flags[0] / RATE_HZ:.3f} s on' if len(flags) else 'not pushed'}")
draw("two_link_urdf", residual, {"shoulder": 0, "elbow": 1}, push)
