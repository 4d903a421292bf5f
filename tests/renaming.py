"""A module's functions with other names for their variables, made in memory."""

import ast
import inspect


def local_names(module) -> list[str]:
    """Every parameter and variable of the module's functions."""
    tree = ast.parse(inspect.getsource(module))
    inside = [x for function in tree.body if isinstance(function, ast.FunctionDef) for x in ast.walk(function)]
    names = {x.arg for x in inside if isinstance(x, ast.arg)}
    names |= {x.id for x in inside if isinstance(x, ast.Name) and isinstance(x.ctx, ast.Store)}
    names |= {x.name for x in inside if isinstance(x, ast.FunctionDef) and x.col_offset}
    return sorted(names)


class Renaming(ast.NodeTransformer):
    def __init__(self, names):
        self.names = names

    def visit_Name(self, name):
        return ast.copy_location(ast.Name(self.names.get(name.id, name.id), name.ctx), name)

    def visit_arg(self, argument):
        argument.arg = self.names.get(argument.arg, argument.arg)
        return argument

    def visit_FunctionDef(self, function):
        if function.col_offset:  # a function in a function
            function.name = self.names.get(function.name, function.name)
        return self.generic_visit(function)


def renamed(module, names: dict[str, str]) -> dict:
    """The module's functions, compiled from its source with other names."""
    tree = ast.fix_missing_locations(Renaming(names).visit(ast.parse(inspect.getsource(module))))
    contents = {"__name__": module.__name__}
    exec(compile(tree, module.__file__, "exec"), contents)
    return contents
