<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0" sync3DRendererTo2DRenderer="1">
  <renderer type="classified" attribute="Reason" pointSize="0.8" pointSizeUnit="MM" pointSizeMapUnitScale="3x:0,0,0,0,0,0" maximumScreenError="0.3" maximumScreenErrorUnit="MM" pointSymbol="1" drawOrder2d="1" renderAsTriangles="0" horizontalTriangleFilter="0" horizontalTriangleFilterThreshold="5" horizontalTriangleFilterUnit="MM">
    <categories>
      <category value="0" label="In no cluster: ground, or too low or too small to be looked at" color="221,221,221,255" pointSize="0" render="true"/>
      <category value="1" label="Building: low entropy, as planes have" color="0,68,136,255" pointSize="0" render="true"/>
      <category value="2" label="Building: low entropy, as planes have, and it stops the beam" color="0,68,136,255" pointSize="0" render="true"/>
      <category value="3" label="Building: the entropy is not low, but next to nothing of the beam passes through" color="102,153,204,255" pointSize="0" render="true"/>
      <category value="4" label="Building: belongs to the roof above, beneath or beside it" color="170,200,230,255" pointSize="0" render="true"/>
      <category value="5" label="Building: low entropy, as planes have, and beside or amid buildings, where what is seen past its edges tells nothing" color="51,119,187,255" pointSize="0" render="true"/>
      <category value="6" label="Building: a plane too large for a crown, though part of the beam passes, as through glass" color="68,170,187,255" pointSize="0" render="true"/>
      <category value="11" label="No building: high entropy, as crowns have" color="221,170,51,255" pointSize="0" render="true"/>
      <category value="12" label="No building: low entropy, but the beam passes through" color="153,119,0,255" pointSize="0" render="true"/>
      <category value="13" label="No building: the surface goes on into the ground" color="170,136,119,255" pointSize="0" render="true"/>
      <category value="14" label="No building: smaller than the smallest building, with all that touches it" color="238,153,170,255" pointSize="0" render="true"/>
      <category value="15" label="No building: narrower everywhere than the narrowest building, as walls and railings are" color="187,85,102,255" pointSize="0" render="true"/>
      <category value="16" label="No building: too near the ground to belong to the roof at its place" color="153,68,85,255" pointSize="0" render="true"/>
      <category value="17" label="No building: too little of what lies at the height of the roof is on surfaces, as in crowns" color="119,51,68,255" pointSize="0" render="true"/>
      <category value="18" label="No building: most of what stands around it is none, as around smooth spots of crowns" color="136,34,85,255" pointSize="0" render="true"/>
      <category value="21" label="Undecided: all clusters have the same entropy" color="120,120,120,255" pointSize="0" render="true"/>
      <category value="22" label="Undecided: its points have no extent, so they have no entropy" color="80,80,80,255" pointSize="0" render="true"/>
    </categories>
  </renderer>
  <blendMode>0</blendMode>
</qgis>
